#pragma once
// Textures of tissue: made by the program (heart muscle, fat, liver capsule, kidney), or from pictures. The
// same bytes on any machine with one compiler; tiles repeat without a seam.

#include "base/result.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace serosa::render {

/// What one tile holds, row 0 first.
struct TissueMaps {
    int width = 0, height = 0;        // texels, powers of two
    std::vector<std::uint8_t> albedo; // sRGB, and roughness (linear)
    std::vector<std::uint8_t>
        relief;        // x and y of the normal (0.5 + 0.5 n), height, light that reaches the place
    glm::vec3 mean{1}; // linear albedo
};

/// 512 x 512 texels. \param tile side of the tile, m: what is on it is drawn in millimetres. \param relief m,
/// from the lowest to the highest
TissueMaps makeTissue(sim::TissueTexture kind, double tile, double relief);

/// The maps of an organ's look. Errors, at the key's line of `scene`: a picture that cannot be read, sides
/// that are no powers of two from 4 to 4096, maps of different sizes.
Result<TissueMaps> tissueMaps(const sim::OrganLook& look, const std::filesystem::path& scene);

} // namespace serosa::render
