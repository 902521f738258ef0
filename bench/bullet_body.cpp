// See bench/bullet_body.h. Bullet 3: predict, one pass over the links, integrate; no collisions, no faces.
#include "bench/bullet_body.h"

#include "base/check.h"

#include <BulletSoftBody/btSoftBody.h>

#include <algorithm>

namespace serosa::bench {

struct BulletBody::World {
    btSoftBodyWorldInfo info;
    std::unique_ptr<btSoftBody> body;
    btScalar timeStep = 0; // s
    std::vector<btVector3> rest;
};

BulletBody::BulletBody(const sim::SolverSetup& setup) : world_(std::make_unique<World>()) {
    const sim::Lattice& lattice = *setup.lattice;
    World& world = *world_;
    world.timeStep = btScalar(setup.timeStep);
    world.info.air_density = 0;
    world.info.m_gravity =
        btVector3(btScalar(setup.gravity.x), btScalar(setup.gravity.y), btScalar(setup.gravity.z));
    std::vector<btScalar> masses;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::dvec3 at = lattice.toWorld(lattice.restPosition(node));
        world.rest.emplace_back(btScalar(at.x), btScalar(at.y), btScalar(at.z));
        const bool fixed = !setup.fixed.empty() && setup.fixed[node];
        masses.push_back(fixed ? 0
                               : btScalar(lattice.massShare(node) * setup.tissue.nodeMass(lattice.spacing)));
    }
    world.body =
        std::make_unique<btSoftBody>(&world.info, int(lattice.nodeCount()), world.rest.data(), masses.data());
    world.body->m_materials[0]->m_kLST = 1;
    world.body->m_cfg.piterations = 1;
    world.body->m_cfg.collisions = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; d += 2)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0)
                world.body->appendLink(int(node), int(other));
}

BulletBody::~BulletBody() = default;

void BulletBody::advance(int count) {
    for (int i = 0; i < count; ++i) {
        world_->body->predictMotion(world_->timeStep);
        world_->body->solveConstraints();
        world_->body->integrateMotion();
    }
}

std::size_t BulletBody::links() const {
    return std::size_t(world_->body->m_links.size());
}

double BulletBody::largestMovement() const {
    double largest = 0;
    for (int node = 0; node < world_->body->m_nodes.size(); ++node)
        largest = std::max(
            largest, double((world_->body->m_nodes[node].m_x - world_->rest[std::size_t(node)]).length()));
    return largest;
}

} // namespace serosa::bench
