// Lattices that the benchmarks step.

#include "bench/cases.h"
#include "gpu/gl.h"
#include "models/phantom.h"

#include <map>

namespace serosa::bench {

Block::Block(sim::Lattice made, double young, double timeStep) : lattice(std::move(made)) {
    setup.lattice = &lattice;
    setup.tissue.young = young;
    setup.tissue.density = 1060;
    setup.gravity = {0, -9.81, 0};
    setup.timeStep = timeStep > 0 ? timeStep : sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    setup.fixed.resize(lattice.nodeCount());
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        setup.fixed[node] = lattice.nodes[node].y == 0;
}

sim::Lattice denseLattice(int nodesAlongAnEdge) {
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z + 1 < nodesAlongAnEdge; ++z)
        for (int y = 0; y + 1 < nodesAlongAnEdge; ++y)
            for (int x = 0; x + 1 < nodesAlongAnEdge; ++x)
                cells.push_back({{x, y, z}, 255});
    return sim::latticeFromCells(std::move(cells), 2.5e-3, glm::dvec3(0));
}

Result<const sim::TriangleMesh*> heartSurface() {
    static sim::TriangleMesh heart;
    if (heart.faces.empty()) {
        SEROSA_ASSIGN(heart, models::phantomInMetres("heart", 50000));
    }
    return &heart;
}

Result<sim::Lattice> heartLattice(std::size_t nodes) {
    SEROSA_ASSIGN(const sim::TriangleMesh* heart, heartSurface());
    sim::LatticeRequest request;
    request.nodes = nodes;
    return sim::buildLattice(*heart, request);
}

void addSolver(Rounds& rounds, const std::string& name, sim::Solver& solver) {
    const bool onGpu = solver.textures() != nullptr;
    rounds.add(name, [&solver, onGpu](int repeats) {
        solver.advance(repeats);
        if (onGpu)
            glFinish();
    });
}

Result<std::unique_ptr<sim::Solver>> fragmentSolver(const Block& block, const sim::FragmentOptions& options) {
    return sim::makeFragmentSolver(block.setup, options);
}

sim::TriangleMesh refined(sim::TriangleMesh mesh, std::size_t least) {
    while (mesh.faces.size() < least) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        std::vector<glm::uvec3> faces;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [found, fresh] =
                middles.try_emplace(std::minmax(a, b), std::uint32_t(mesh.positions.size()));
            if (fresh) {
                mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
                if (!mesh.colours.empty())
                    mesh.colours.push_back(mesh.colours[a]);
            }
            return found->second;
        };
        for (const glm::uvec3& f : mesh.faces) {
            const std::uint32_t a = middle(f.x, f.y), b = middle(f.y, f.z), c = middle(f.z, f.x);
            faces.insert(faces.end(), {{f.x, a, c}, {f.y, b, a}, {f.z, c, b}, {a, b, c}});
        }
        mesh.faces = std::move(faces);
    }
    return mesh;
}

} // namespace serosa::bench
