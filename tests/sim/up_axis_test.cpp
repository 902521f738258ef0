// Turning a model: the named axis ends up, handedness stays, the inverse brings every digit back.
#include "sim/scene_keys.h"
#include "sim/up_axis.h"

#include <gtest/gtest.h>

namespace serosa::sim {
namespace {

const UpAxis kAll[] = {UpAxis::y, UpAxis::x, UpAxis::z, UpAxis::minusY, UpAxis::minusX, UpAxis::minusZ};

TEST(UpAxis, TakesTheNamedAxisUp) {
    const glm::dvec3 axes[] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {-1, 0, 0}, {0, 0, -1}};
    for (const UpAxis up : kAll)
        EXPECT_EQ(worldFromFile(up, axes[int(up)]), glm::dvec3(0, 1, 0)) << int(up);
    EXPECT_EQ(worldFromFile(UpAxis::z, {1, 2, 3}), glm::dvec3(1, 3, -2));
}

TEST(UpAxis, IsAProperRotationWithAnExactInverse) {
    const glm::dvec3 p(0.1, -2.7, 31.3);
    for (const UpAxis up : kAll) {
        const glm::dmat3 m(worldFromFile(up, {1, 0, 0}), worldFromFile(up, {0, 1, 0}),
                           worldFromFile(up, {0, 0, 1}));
        EXPECT_EQ(glm::determinant(m), 1) << int(up);
        EXPECT_EQ(glm::transpose(m) * m, glm::dmat3(1)) << int(up);
        EXPECT_EQ(fileFromWorld(up, worldFromFile(up, p)), p) << int(up);
        EXPECT_EQ(worldFromFile(up, fileFromWorld(up, p)), p) << int(up);
    }
}

TEST(UpAxis, WordsStandInTheOrderOfTheEnum) {
    const std::vector<std::string> words{"y", "x", "z", "-y", "-x", "-z"};
    EXPECT_EQ(findSceneKey("organ", "up_axis")->words, words);
}

} // namespace
} // namespace serosa::sim
