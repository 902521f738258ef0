// See render/tissue_texture.h. Sizes are those of the tissue: muscle bundles of 0.7 mm, fat lobules of 2.6
// mm, liver lobules of 1.3 mm, the kidney's stellate veins some 5 mm apart.
#include "render/tissue_texture.h"

#include "render/image.h"
#include "render/parallel.h"
#include "render/tissue_noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace serosa::render {

namespace {

constexpr int kSide = 512; // texels
constexpr int kSmallest = 4, kLargest = 4096;

/// One place of a tissue.
struct Sample {
    glm::dvec3 albedo{0.5}; // linear
    double roughness = 0.4, height = 0.5;
};

double ridge(double noise) {
    return 1 - std::abs(noise);
}
double step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// How often something of `size` mm fits a tile of `tile` mm.
int periods(double tile, double size) {
    return std::max(1, int(std::lround(tile / size)));
}

Sample heartMuscle(const glm::dvec2& at, double tile) {
    const glm::ivec2 broad(periods(tile, 8), periods(tile, 8));
    const double wave = layeredNoise(at * glm::dvec2(broad), broad, 3, 11);
    const auto fibres = [&](double along, double across, std::uint32_t seed) {
        const glm::ivec2 n(periods(tile, along), periods(tile, across));
        return gradientNoise((at + glm::dvec2(0, 0.02 * wave)) * glm::dvec2(n), n, seed);
    };
    const double bundle = ridge(fibres(7, 0.8, 1)), fine = ridge(fibres(3, 0.3, 2)), pale = fibres(10, 2, 3);
    Sample s;
    s.height = 0.25 + 0.28 * bundle * bundle + 0.08 * fine + 0.3 * (0.5 + 0.5 * wave);
    const double light =
        std::clamp(0.35 + 0.28 * bundle * bundle + 0.10 * fine * fine + 0.3 * wave, 0.0, 1.0);
    s.albedo = glm::mix(glm::dvec3(0.20, 0.022, 0.018), glm::dvec3(0.43, 0.095, 0.070), light);
    s.albedo = glm::mix(s.albedo, glm::dvec3(0.52, 0.22, 0.15), 0.35 * step(0.35, 0.9, pale)); // fascia
    s.roughness = 0.34 + 0.12 * fine;
    return s;
}

Sample fat(const glm::dvec2& at, double tile) {
    const glm::ivec2 broad(periods(tile, 5), periods(tile, 5));
    const double wave = layeredNoise(at * glm::dvec2(broad), broad, 3, 21);
    const glm::ivec2 n(periods(tile, 2.6), periods(tile, 2.6)), small = n * 2;
    const glm::dvec2 bent = at + 0.015 * glm::dvec2(wave, layeredNoise(at * glm::dvec2(broad), broad, 3, 22));
    const CellDistances lobule = cellNoise(bent * glm::dvec2(n), n, 23);
    const CellDistances lobe = cellNoise(bent * glm::dvec2(small), small, 24);
    const double edge = step(0.0, 0.28, lobule.next - lobule.nearest);
    Sample s;
    s.height =
        0.7 * std::sqrt(edge) * (1 - 0.4 * lobule.nearest) + 0.25 * step(0, 0.4, lobe.next - lobe.nearest);
    s.albedo = glm::mix(glm::dvec3(0.50, 0.22, 0.085), glm::dvec3(0.74, 0.50, 0.21), edge) *
               (0.92 + 0.12 * unitOf(lobule.id));
    const double vessel = ridge(gradientNoise((bent + 0.02 * wave) * glm::dvec2(broad * 2), broad * 2, 25));
    s.albedo = glm::mix(s.albedo, glm::dvec3(0.42, 0.05, 0.035), 0.5 * step(0.965, 1.0, vessel));
    s.roughness = 0.30 + 0.1 * (1 - edge);
    return s;
}

Sample liverCapsule(const glm::dvec2& at, double tile) {
    const glm::ivec2 broad(periods(tile, 9), periods(tile, 9)), n(periods(tile, 1.3), periods(tile, 1.3));
    const double mottle = layeredNoise(at * glm::dvec2(broad), broad, 4, 31);
    const glm::dvec2 bent =
        at + 0.004 * glm::dvec2(mottle, layeredNoise(at * glm::dvec2(broad), broad, 4, 32));
    const CellDistances lobule = cellNoise(bent * glm::dvec2(n), n, 33);
    const double edge = step(0.0, 0.35, lobule.next - lobule.nearest);
    const double grain = gradientNoise(at * glm::dvec2(n * 4), n * 4, 34);
    Sample s;
    s.height = 0.2 + 0.10 * edge + 0.5 * (0.5 + 0.5 * mottle) + 0.08 * grain;
    s.albedo = glm::mix(glm::dvec3(0.165, 0.034, 0.024), glm::dvec3(0.245, 0.062, 0.042), 0.5 + 0.6 * mottle);
    s.albedo *= glm::mix(1.25, 0.97, edge) * (1 + 0.06 * grain) * (0.95 + 0.1 * unitOf(lobule.id));
    s.roughness = 0.26 + 0.06 * (1 - edge);
    return s;
}

Sample kidney(const glm::dvec2& at, double tile) {
    const glm::ivec2 broad(periods(tile, 7), periods(tile, 7)), n(periods(tile, 5), periods(tile, 5));
    const double mottle = layeredNoise(at * glm::dvec2(broad), broad, 4, 41);
    const glm::dvec2 bent =
        at + 0.03 * glm::dvec2(mottle, layeredNoise(at * glm::dvec2(broad), broad, 4, 42));
    const CellDistances star = cellNoise(bent * glm::dvec2(n), n, 43);
    const glm::ivec2 fine(periods(tile, 0.5), periods(tile, 0.5));
    const double grain = gradientNoise(at * glm::dvec2(fine), fine, 44);
    const double vein =
        (1 - step(0.0, 0.09, star.next - star.nearest)) * step(-0.35, 0.35, mottle + 0.4 * grain);
    Sample s;
    s.height = 0.5 + 0.35 * mottle + 0.12 * grain + 0.15 * vein;
    s.albedo =
        glm::mix(glm::dvec3(0.245, 0.058, 0.045), glm::dvec3(0.335, 0.100, 0.075), 0.5 + 0.6 * mottle) *
        (1 + 0.10 * grain);
    s.albedo = glm::mix(s.albedo, glm::dvec3(0.15, 0.018, 0.020), 0.6 * vein);
    s.roughness = 0.30 + 0.05 * grain;
    return s;
}

Sample sampleOf(sim::TissueTexture kind, const glm::dvec2& at, double tile) {
    switch (kind) {
    case sim::TissueTexture::heartMuscle:
        return heartMuscle(at, tile);
    case sim::TissueTexture::fat:
        return fat(at, tile);
    case sim::TissueTexture::liverCapsule:
        return liverCapsule(at, tile);
    case sim::TissueTexture::kidney:
        return kidney(at, tile);
    case sim::TissueTexture::none:
        break;
    }
    return {};
}

std::uint8_t byteOf(double share) {
    return std::uint8_t(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}
double srgbOf(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
double linearOf(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

/// Fills relief from heights (0..1). \param steepness relief over the side of a texel
void setRelief(TissueMaps& maps, const std::vector<double>& heights, double steepness, bool normals) {
    const int w = maps.width, h = maps.height;
    const auto at = [&](int x, int y) { return heights[std::size_t(wrapped(y, h) * w + wrapped(x, w))]; };
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            std::uint8_t* texel = &maps.relief[4 * std::size_t(y * w + x)];
            if (normals) {
                const glm::dvec3 n =
                    glm::normalize(glm::dvec3(0.5 * steepness * (at(x - 1, y) - at(x + 1, y)),
                                              0.5 * steepness * (at(x, y - 1) - at(x, y + 1)), 1));
                texel[0] = byteOf(0.5 + 0.5 * n.x);
                texel[1] = byteOf(0.5 + 0.5 * n.y);
            }
            constexpr int kAround = 6; // texels: what a dip is lower than
            const double mean =
                0.25 * (at(x - kAround, y) + at(x + kAround, y) + at(x, y - kAround) + at(x, y + kAround));
            texel[2] = byteOf(at(x, y));
            texel[3] = byteOf(0.9 + std::min(0.1, 1.2 * (at(x, y) - mean)));
        }
}

/// "scene.toml:12: "
std::string position(const std::filesystem::path& scene, int line) {
    return scene.empty() || line == 0 ? "" : scene.string() + ":" + std::to_string(line) + ": ";
}

Result<Image> readMap(const std::filesystem::path& file, const std::string& where) {
    Result<Image> image = readPng(file);
    if (!image)
        return Error{where + image.error().message};
    for (const int side : {image->width, image->height})
        if (side < kSmallest || side > kLargest || !std::has_single_bit(unsigned(side)))
            return Error{where + file.string() + ": is " + std::to_string(image->width) + " x " +
                         std::to_string(image->height) +
                         " pixels, and textures repeat and shrink by halves: scale it to powers of two from "
                         "4 to 4096"};
    return image;
}

} // namespace

TissueMaps makeTissue(sim::TissueTexture kind, double tile, double relief) {
    TissueMaps maps{kSide, kSide, std::vector<std::uint8_t>(4 * kSide * kSide),
                    std::vector<std::uint8_t>(4 * kSide * kSide), glm::vec3(0)};
    std::vector<double> heights(kSide * kSide);
    parallelFor(kSide, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < kSide; ++x) {
                const Sample s =
                    sampleOf(kind, glm::dvec2(double(x) + 0.5, double(y) + 0.5) / double(kSide), 1e3 * tile);
                const std::size_t i = y * kSide + x;
                for (int c = 0; c < 3; ++c)
                    maps.albedo[4 * i + std::size_t(c)] = byteOf(srgbOf(std::clamp(s.albedo[c], 0.0, 1.0)));
                maps.albedo[4 * i + 3] = byteOf(s.roughness);
                heights[i] = std::clamp(s.height, 0.0, 1.0);
            }
    });
    setRelief(maps, heights, relief * kSide / tile, true);
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < heights.size(); ++i)
        for (int c = 0; c < 3; ++c)
            sum[c] += linearOf(maps.albedo[4 * i + std::size_t(c)] / 255.0);
    maps.mean = glm::vec3(sum / double(heights.size()));
    return maps;
}

Result<TissueMaps> tissueMaps(const sim::OrganLook& look, const std::filesystem::path& scene) {
    if (look.texture != sim::TissueTexture::none)
        return makeTissue(look.texture, look.tile, look.relief);
    struct Map {
        const std::filesystem::path& file;
        int line;
        Image image;
    };
    std::array<Map, 3> given = {{{look.albedo, look.albedoLine, {}},
                                 {look.normal, look.normalLine, {}},
                                 {look.height, look.heightLine, {}}}};
    TissueMaps maps;
    for (Map& map : given) {
        if (map.file.empty())
            continue;
        SEROSA_ASSIGN(map.image, readMap(map.file, position(scene, map.line)));
        if (maps.width > 0 && (map.image.width != maps.width || map.image.height != maps.height))
            return Error{position(scene, map.line) + map.file.string() + ": is " +
                         std::to_string(map.image.width) + " x " + std::to_string(map.image.height) +
                         " pixels, the map before it " + std::to_string(maps.width) + " x " +
                         std::to_string(maps.height) + ": scale one to the size of the other"};
        maps.width = map.image.width;
        maps.height = map.image.height;
    }
    const std::size_t texels = std::size_t(maps.width) * std::size_t(maps.height);
    maps.albedo.assign(4 * texels, 255);
    maps.relief.assign(4 * texels, 128);
    std::vector<double> heights(texels, 0.5);
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < texels; ++i) {
        const std::size_t row = i / std::size_t(maps.width); // pictures begin at the top, textures below
        const std::size_t from =
            3 * (texels - (row + 1) * std::size_t(maps.width) + i % std::size_t(maps.width));
        for (std::size_t c = 0; c < 3; ++c) {
            if (!given[0].file.empty())
                maps.albedo[4 * i + c] = given[0].image.rgb[from + c];
            sum[int(c)] += linearOf(maps.albedo[4 * i + c] / 255.0);
        }
        maps.albedo[4 * i + 3] = byteOf(0.35);
        for (std::size_t c = 0; c < 2 && !given[1].file.empty(); ++c)
            maps.relief[4 * i + c] = given[1].image.rgb[from + c];
        if (!given[2].file.empty())
            heights[i] = given[2].image.rgb[from] / 255.0;
    }
    setRelief(maps, heights, look.relief * maps.width / look.tile, given[1].file.empty());
    maps.mean = glm::vec3(sum / double(texels));
    return maps;
}

} // namespace serosa::render
