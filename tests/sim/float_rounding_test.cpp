// The compiler must keep the rounding to float32 that a conversion through float means: g++ 12 with its
// basic-block vectorizer does not (CMakeLists.txt switches that off), and the twins of float32 shaders rely
// on it.
#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <vector>

namespace {

std::vector<glm::dvec3> roundedAll(const std::vector<glm::dvec3>& values) {
    std::vector<glm::dvec3> rounded;
    for (const glm::dvec3& v : values)
        rounded.push_back(glm::dvec3(glm::vec3(v)));
    return rounded;
}

} // namespace

TEST(FloatRounding, conversionThroughFloatRounds) {
    const std::vector<glm::dvec3> got = roundedAll({{0.1, 0.2, 0.3}, {0.7, 1.0 / 3, 0.9}});
    for (const glm::dvec3& v : got)
        for (int i = 0; i < 3; ++i) {
            volatile float rounded = float(v[i]);
            EXPECT_EQ(v[i], double(rounded));
        }
    EXPECT_NE(got[0].x, 0.1);
}
