// A lattice from a closed surface: the spacing that gives a wanted number of nodes, memory limits, and fills.
#include "sim/cell_fills.h"
#include "sim/lattice.h"
#include "sim/node_depths.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

namespace serosa::sim {

namespace {

// A cell that is filled by less is not touched but for rounding.
constexpr double kLeastFill = 1e-6;
// Host and texture bytes, generously: a cell of the box while building; a node with its textures, twice
// buffered.
constexpr double kBytesPerBoxCell = 24, kBytesPerNode = 360;

double availableBytes() {
    std::ifstream file("/proc/meminfo");
    std::string key, unit;
    double kibibytes = 0;
    while (file >> key >> kibibytes) {
        std::getline(file, unit);
        if (key == "MemAvailable:")
            return kibibytes * 1024;
    }
    return 4.0 * 1024 * 1024 * 1024; // no procfs: assume a small machine
}

std::string decimal(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

/// Lower bound of the bytes that a spacing needs, before anything is allocated.
double bytesNeeded(const glm::dvec3& extent, double volume, double spacing) {
    const glm::dvec3 cells = glm::max(extent / spacing, glm::dvec3(1));
    return cells.x * cells.y * cells.z * kBytesPerBoxCell +
           volume / (spacing * spacing * spacing) * kBytesPerNode;
}

/// Fills of the smallest grid around the surface.
struct Filled {
    CellGrid grid;
    std::vector<double> fills;
};

Filled fillAt(const TriangleMesh& metres, const glm::dvec3& low, const glm::dvec3& high, double spacing,
              const std::optional<glm::dvec3>& gridPoint = {}) {
    Filled filled{gridPoint ? gridThrough(*gridPoint, low, high, spacing) : gridAround(low, high, spacing),
                  {}};
    filled.fills = cellFills(metres, filled.grid);
    return filled;
}

std::size_t countNodes(const Filled& filled) {
    const glm::ivec3 dims = filled.grid.dims;
    const glm::ivec3 nodes = dims + 1;
    std::vector<bool> used(std::size_t(nodes.x) * std::size_t(nodes.y) * std::size_t(nodes.z), false);
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                if (filled.fills[filled.grid.index(x, y, z)] <= kLeastFill)
                    continue;
                for (int corner = 0; corner < 8; ++corner) {
                    const int nx = x + (corner & 1), ny = y + ((corner >> 1) & 1), nz = z + (corner >> 2);
                    used[(std::size_t(nz) * std::size_t(nodes.y) + std::size_t(ny)) * std::size_t(nodes.x) +
                         std::size_t(nx)] = true;
                }
            }
    return std::size_t(std::count(used.begin(), used.end(), true));
}

Status checkMemory(const glm::dvec3& extent, double volume, double spacing, double maxBytes,
                   const std::string& asked) {
    const double needed = bytesNeeded(extent, volume, spacing);
    if (needed <= maxBytes)
        return {};
    double fits = spacing;
    while (bytesNeeded(extent, volume, fits) > maxBytes)
        fits *= 1.05;
    return Error{asked + " needs about " + decimal(needed / 1e9, 3) + " GB for the lattice, " +
                 decimal(maxBytes / 1e9, 3) + " GB may be used: take a spacing of at least " +
                 decimal(fits * 1e3, 3) + " mm"};
}

/// The spacing whose node count is closest to `wanted`: counts fall about with the cube of the spacing, so a
/// few multiplicative steps come close, and the best one seen is taken.
Result<Filled> fillForNodes(const TriangleMesh& metres, const glm::dvec3& low, const glm::dvec3& high,
                            double volume, std::size_t wanted, double maxBytes) {
    double spacing = std::cbrt(std::max(volume, 1e-30) / double(wanted)) * 1.3;
    const double longest = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    double tooFine = 0, tooCoarse = 0; // spacings with more and with fewer nodes than wanted
    Filled best;
    double bestMiss = 1e30;
    for (int attempt = 0; attempt < 24; ++attempt) {
        spacing = std::min(spacing, longest);
        SEROSA_TRY(checkMemory(high - low, volume, spacing, maxBytes, std::to_string(wanted) + " nodes"));
        Filled filled = fillAt(metres, low, high, spacing);
        const double count = double(countNodes(filled));
        const double miss = std::abs(count / double(wanted) - 1);
        if (miss < bestMiss) {
            bestMiss = miss;
            best = std::move(filled);
        }
        if (bestMiss < 0.005)
            break;
        (count > double(wanted) ? tooFine : tooCoarse) = spacing;
        const double guess = spacing * std::cbrt(count / double(wanted));
        const bool bracketed = tooFine > 0 && tooCoarse > 0;
        const double low2 = std::min(tooFine, tooCoarse), high2 = std::max(tooFine, tooCoarse);
        if (bracketed && high2 / low2 < 1 + 1e-5)
            break;
        spacing = bracketed && (guess <= low2 || guess >= high2 || attempt % 3 == 2) ? std::sqrt(low2 * high2)
                                                                                     : guess;
    }
    return best;
}

} // namespace

Result<Lattice> buildLattice(const TriangleMesh& metres, const LatticeRequest& request) {
    if (request.spacing < 0 || !std::isfinite(request.spacing))
        return Error{"the lattice spacing must be a positive length"};
    if (request.spacing == 0 && request.nodes < 8)
        return Error{"a lattice has at least 8 nodes; " + std::to_string(request.nodes) + " were asked for"};
    const double maxBytes = request.maxBytes > 0 ? double(request.maxBytes) : 0.75 * availableBytes();
    const glm::dvec3 low = metres.lowest(), high = metres.highest();
    const double volume = std::max(metres.volume(), 0.0);

    Filled filled;
    if (request.spacing > 0) {
        SEROSA_TRY(checkMemory(high - low, volume, request.spacing, maxBytes,
                               "a spacing of " + decimal(request.spacing * 1e3, 3) + " mm"));
        filled = fillAt(metres, low, high, request.spacing, request.gridPoint);
    } else {
        SEROSA_ASSIGN(filled, fillForNodes(metres, low, high, volume, request.nodes, maxBytes));
    }

    std::vector<LatticeCell> cells;
    const glm::ivec3 dims = filled.grid.dims;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                const double fill = filled.fills[filled.grid.index(x, y, z)];
                if (fill > kLeastFill)
                    cells.push_back({{x, y, z}, std::uint8_t(std::max(1.0, std::floor(fill * 255 + 0.5)))});
            }
    if (cells.empty())
        return Error{"the surface has no inside at a spacing of " + decimal(filled.grid.spacing * 1e3, 3) +
                     " mm"};
    Lattice lattice = latticeFromCells(std::move(cells), filled.grid.spacing, filled.grid.origin);
    lattice.exactVolume = volume;
    lattice.depthSteps = surfaceDepths(lattice, metres);
    return lattice;
}

} // namespace serosa::sim
