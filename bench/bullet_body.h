#pragma once
// Bullet's soft body (position-based links, one iteration) on the springs of a lattice: the yardstick of
// `bullet_over_...`.

#include "sim/solver.h"

#include <memory>

namespace serosa::bench {

class BulletBody {
public:
    /// Every spring of the lattice becomes a link of full stiffness; fixed nodes get no mass. Metres.
    explicit BulletBody(const sim::SolverSetup& setup);
    ~BulletBody();
    BulletBody(const BulletBody&) = delete;
    BulletBody& operator=(const BulletBody&) = delete;

    /// Steps of the setup's time step, on one thread (it has no more).
    void advance(int count);
    std::size_t links() const;
    /// Metres from the rest position, of the node that moved most.
    double largestMovement() const;

private:
    struct World;
    std::unique_ptr<World> world_;
};

} // namespace serosa::bench
