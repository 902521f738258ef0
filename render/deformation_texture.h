#pragma once
// Deformation textures (CS07 section 4): the inverse displacement D and the mask A, sampled on a regular grid
// and interpolated trilinearly, as the deformation shader reads them. D in texture-space units (m), A 1 where
// kept and 0 where cut away, threshold 0.5, linear in the distance from the cut over kMaskBand texels. (CS07
// keeps where A < 0.)
//
// Texel (i, j, k) lies at ((i, j, k) + 0.5) / size of the box; beyond the outer texels' middles the nearest
// counts, outside of the box nothing moves and all is kept. Of size 1 along an axis: constant there.

#include "base/result.h"
#include "render/deformation_map.h"
#include "render/texture_mapping.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace serosa::render {

inline constexpr double kMaskBand = 4; // texels over which the mask goes from 0 to 1

/// A texel is D.xyz and A: 4, 8 (CS07's 8 w h d bytes) or 16 bytes.
enum class TexelFormat { unorm8, half, single };

class DeformationTexture {
public:
    /// \param half of the box, texture space, m, > 0. \param texels D (m) and A in [0, 1], x fastest.
    /// What is kept of them is what `format` can hold. Errors: a size below 1, a texel that is no number, D
    /// larger than the box, nothing that is not cut away.
    static Result<DeformationTexture> create(const glm::ivec3& size, const glm::dvec3& half,
                                             TexelFormat format, const std::vector<glm::dvec4>& texels);
    /// Samples a closed-form map. Errors: as problemOf, and as create.
    static Result<DeformationTexture> bake(const DeformationMap& map, const glm::ivec3& size,
                                           TexelFormat format);
    /// Sum of the displacements; a point is kept where both keep it. Errors: other sizes or boxes.
    static Result<DeformationTexture> sum(const DeformationTexture& a, const DeformationTexture& b);

    const glm::ivec3& size() const { return size_; }
    const glm::dvec3& half() const { return half_; }
    TexelFormat format() const { return format_; }
    std::size_t bytes() const; // of the texture on the GPU
    /// As they are stored, four a texel: for upload. unorm8 holds bytes: D = scale() (byte - 128) / 127.
    const std::vector<std::uint8_t>& stored() const { return *stored_; }
    /// The same, which copies share: who keeps it can tell whether a texture is the one it had.
    const std::shared_ptr<const std::vector<std::uint8_t>>& shared() const { return stored_; }
    /// m: what the largest stored component stands for.
    double scale() const { return scale_; }
    /// Longest D of a texel, m.
    double largest() const { return largest_; }
    /// Does any texel cut?
    bool cuts() const { return cuts_; }

    /// D and A of a texel, of the nearest one where there is none.
    glm::dvec4 texel(int x, int y, int z) const {
        const glm::ivec3 at = glm::clamp(glm::ivec3(x, y, z), glm::ivec3(0), size_ - 1);
        return texels_[std::size_t(at.x) +
                       std::size_t(size_.x) * (std::size_t(at.y) + std::size_t(size_.y) * std::size_t(at.z))];
    }
    /// D and A at a place of texture space, as a linear texture filter gives them.
    glm::dvec4 sample(const glm::dvec3& texture) const;
    /// d D / d q by central differences over a texel; column j in [j].
    glm::dmat3 gradient(const glm::dvec3& texture) const;
    /// The same of A.
    glm::dvec3 maskGradient(const glm::dvec3& texture) const;
    glm::dvec3 texelSize() const { return 2.0 * half_ / glm::dvec3(size_); } // m

private:
    glm::ivec3 size_{1};
    glm::dvec3 half_{0.5};
    TexelFormat format_ = TexelFormat::half;
    double scale_ = 1, largest_ = 0;
    bool cuts_ = false;
    std::shared_ptr<const std::vector<std::uint8_t>> stored_;
    std::vector<glm::vec4> texels_; // as a shader reads them
};

/// The whole map of CS07 eq. 2 in double: a texture and where it lies.
struct Warp {
    const DeformationTexture* texture = nullptr;
    TextureMapping mapping; // object space to the texture's

    struct Point {
        glm::dvec3 rest{0};  // p
        double mask = 1;     // A at M^-1 p'
        bool inside = false; // of the box
    };
    Point at(const glm::dvec3& shown) const;
    /// dp / dp'
    glm::dmat3 jacobian(const glm::dvec3& shown) const;
    /// Gradient of the mask in object space, by M's inverse transpose.
    glm::dvec3 maskGradient(const glm::dvec3& shown) const;
};

} // namespace serosa::render
