// See app/deformation_file.h.
#include "app/deformation_file.h"

#include "app/vector_image.h"

namespace serosa::app {

namespace {

constexpr double kMetre = 1000; // mm

Result<VectorImage> readOf(const std::filesystem::path& file, int components, const char* what) {
    SEROSA_ASSIGN(VectorImage image, readVectorImage(file));
    if (image.components != components)
        return Error{file.string() + ": has " + std::to_string(image.components) + " numbers a voxel, and " +
                     what + " has " + std::to_string(components)};
    return image;
}

glm::dvec3 halfOf(const VectorImage& image) {
    return 0.5 / kMetre * image.spacing * glm::dvec3(image.size);
}

} // namespace

Status writeDeformationTexture(const render::DeformationTexture& texture, const std::filesystem::path& file) {
    VectorImage image;
    image.size = texture.size();
    image.spacing = kMetre * texture.texelSize();
    image.origin = 0.5 * image.spacing - kMetre * texture.half();
    image.components = 4;
    for (int z = 0; z < image.size.z; ++z)
        for (int y = 0; y < image.size.y; ++y)
            for (int x = 0; x < image.size.x; ++x) {
                const glm::dvec4 texel =
                    texture.sample((glm::dvec3(x, y, z) + 0.5) * texture.texelSize() - texture.half());
                for (int c = 0; c < 3; ++c)
                    image.values.push_back(float(kMetre * texel[c]));
                image.values.push_back(float(texel.w));
            }
    return writeVectorImage(image, file);
}

Result<render::DeformationTexture> readDeformationTexture(const std::filesystem::path& file,
                                                          render::TexelFormat format) {
    SEROSA_ASSIGN(const VectorImage image, readOf(file, 4, "a deformation texture"));
    std::vector<glm::dvec4> texels;
    for (std::size_t i = 0; i < image.values.size(); i += 4) {
        const float* v = &image.values[i];
        texels.emplace_back(v[0] / kMetre, v[1] / kMetre, v[2] / kMetre, v[3]);
    }
    Result<render::DeformationTexture> made =
        render::DeformationTexture::create(image.size, halfOf(image), format, texels);
    if (!made.ok())
        return Error{file.string() + ": " + made.error().message};
    return made;
}

Result<render::InvertedDisplacement> readForwardDisplacement(const std::filesystem::path& file,
                                                             render::TexelFormat format) {
    SEROSA_ASSIGN(const VectorImage image, readOf(file, 3, "a forward displacement"));
    std::vector<glm::dvec3> forward;
    for (std::size_t i = 0; i < image.values.size(); i += 3)
        forward.emplace_back(glm::dvec3(image.values[i], image.values[i + 1], image.values[i + 2]) / kMetre);
    Result<render::InvertedDisplacement> made =
        render::invertDisplacement(forward, image.size, halfOf(image), format);
    if (!made.ok())
        return Error{file.string() + ": " + made.error().message};
    return made;
}

} // namespace serosa::app
