#pragma once
// Deformation textures and forward displacements as images (CS07 section 4: what was made once is used
// again).

#include "base/result.h"
#include "render/deformation_sources.h"

#include <filesystem>

namespace serosa::app {

/// D in millimetres and the mask, four float32 a texel; the image's spacing and origin say how large the box
/// is, with its middle at the origin. .nrrd or .mha. Errors: of the file.
Status writeDeformationTexture(const render::DeformationTexture& texture, const std::filesystem::path& file);
/// Errors: of the file, of its numbers (with their voxel).
Result<render::DeformationTexture> readDeformationTexture(const std::filesystem::path& file,
                                                          render::TexelFormat format);
/// A forward displacement from elsewhere, three components in millimetres a voxel, inverted. The box is the
/// image's; where it lies is the scene's business. Errors: as before.
Result<render::InvertedDisplacement> readForwardDisplacement(const std::filesystem::path& file,
                                                             render::TexelFormat format);

} // namespace serosa::app
