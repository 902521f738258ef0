// See app/verify/surface_cases.h.
#include "app/verify/surface_cases.h"

#include "models/phantom.h"
#include "models/simple_shapes.h"

#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <random>

namespace serosa::app {

Result<SurfaceCase> surfaceCase(const std::string& phantom, std::size_t faces, std::size_t nodes,
                                double spacing) {
    SurfaceCase made;
    SEROSA_ASSIGN(made.mesh, models::phantomInMetres(phantom, faces));
    sim::LatticeRequest request;
    request.nodes = nodes;
    request.spacing = spacing;
    SEROSA_ASSIGN(made.lattice, sim::buildLattice(made.mesh, request));
    return made;
}

Result<SurfaceCase> randomSurface(unsigned number) {
    std::mt19937 random(number);
    const auto uniform = [&] { return random() / 4294967296.0 * 2 - 1; };
    const auto direction = [&] { return glm::normalize(glm::dvec3(uniform(), uniform(), uniform() + 1e-3)); };
    struct Wave {
        glm::dvec3 along;
        double phase, height;
    };
    std::vector<Wave> waves;
    for (int i = 0; i < 4; ++i)
        waves.push_back({(3 + 2 * uniform()) * direction(), 3.14 * uniform(), 0.09 * uniform()});
    const glm::dvec3 extent(1 + 0.4 * uniform(), 1 + 0.4 * uniform(), 1 + 0.4 * uniform());
    const glm::dquat turn = glm::angleAxis(3.14 * uniform(), direction());
    const glm::dvec3 away(uniform(), uniform(), uniform()); // m: organs of a body lie far from the origin

    SurfaceCase made;
    SEROSA_ASSIGN(made.mesh, models::makeBall(2000));
    for (glm::dvec3& p : made.mesh.positions) {
        const glm::dvec3 n = glm::normalize(p);
        double r = 1;
        for (const Wave& wave : waves)
            r += wave.height * std::sin(glm::dot(wave.along, n) + wave.phase);
        p = turn * (0.04 * r * extent * n) + away;
    }
    sim::LatticeRequest request;
    request.nodes = std::size_t(1700 + 1300 * uniform());
    SEROSA_ASSIGN(made.lattice, sim::buildLattice(made.mesh, request));
    return made;
}

Status verifySurface(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(verifySurfaceFigures(options, checks));
    SEROSA_TRY(verifySurfaceExactness(options, checks));
    return verifySurfaceNormals(options, checks);
}

} // namespace serosa::app
