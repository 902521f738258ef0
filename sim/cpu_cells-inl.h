// Passes over cells before a step, a vector of cells at a time, a cell at the slot of its lowest corner:
// the volumetric term (sim/volume_term.h), and by how much cells stiffen (sim/stiffening.h). Included once
// for each instruction set by sim/cpu_kernel.cpp.
//
// Two cells that lie side by side along x share the four rows of nodes along x, so that their force on a node
// is summed here already: a node gathers four vectors instead of eight times nine numbers. Every slot is
// written by its own chunk and holds the same sum whatever the chunk.
#if defined(SEROSA_SIM_CPU_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SEROSA_SIM_CPU_CELLS_INL_H
#undef SEROSA_SIM_CPU_CELLS_INL_H
#else
#define SEROSA_SIM_CPU_CELLS_INL_H
#endif

#include "sim/cpu_kernel.h"
#include "sim/cpu_lanes-inl.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace serosa::sim::HWY_NAMESPACE {

/// Energy of the spring to slot `other` in a cell, of constant k: 0 where it is cut.
template <bool kDiagonal>
HWY_INLINE void storeStretch(Lanes d, const CpuCellPass& pass, hn::Vec<Words> bits, int direction,
                             std::size_t slot, std::size_t other) {
    const Vec dx = hn::Sub(hn::Load(d, pass.positions[0] + slot), hn::LoadU(d, pass.positions[0] + other));
    const Vec dy = hn::Sub(hn::Load(d, pass.positions[1] + slot), hn::LoadU(d, pass.positions[1] + other));
    const Vec dz = hn::Sub(hn::Load(d, pass.positions[2] + slot), hn::LoadU(d, pass.positions[2] + other));
    Vec length2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
    if constexpr (kDiagonal)
        length2 = hn::Mul(length2, hn::Set(d, 0.5f));
    length2 = hn::Max(length2, hn::Set(d, 1e-12f));
    // Length over rest length, less 1: exactly 0 at rest.
    const Vec stretch = hn::MulSub(length2, reciprocalRoot(d, length2), hn::Set(d, 1.0f));
    // Half of k/4 on an edge, of k/2 and a squared rest length of 2 on a diagonal.
    const Vec energy = hn::Mul(hn::Mul(stretch, stretch), hn::Set(d, kDiagonal ? 0.5f : 0.125f));
    hn::Store(hn::IfThenElseZero(lanesWith(d, bits, 1u << direction), energy), d,
              pass.stretches[direction / 2] + slot);
}

void stretchBlocks(const CpuCellPass& pass, std::size_t firstBlock, std::size_t lastBlock) {
    const Lanes d;
    for (std::size_t block = firstBlock; block < lastBlock; ++block) {
        const std::size_t slot = pass.first + block * hn::Lanes(d);
        const std::int32_t* rows = pass.rows + block * 8;
        const auto bits = hn::Load(Words(), pass.bits + slot);
        storeStretch<false>(d, pass, bits, 0, slot, slotBeside(slot, rows, 1, kSame));
        storeStretch<false>(d, pass, bits, 2, slot, slotBeside(slot, rows, 0, kY));
        storeStretch<false>(d, pass, bits, 4, slot, slotBeside(slot, rows, 0, kZ));
        storeStretch<true>(d, pass, bits, 6, slot, slotBeside(slot, rows, 1, kY));
        storeStretch<true>(d, pass, bits, 8, slot, slotBeside(slot, rows, 1, ky));
        storeStretch<true>(d, pass, bits, 10, slot, slotBeside(slot, rows, 1, kZ));
        storeStretch<true>(d, pass, bits, 12, slot, slotBeside(slot, rows, 1, kz));
        storeStretch<true>(d, pass, bits, 14, slot, slotBeside(slot, rows, 0, kYZ));
        storeStretch<true>(d, pass, bits, 16, slot, slotBeside(slot, rows, 0, kYz));
    }
}

/// Slots of a cell's corners: corner c at +x if c & 1, +y if c & 2, +z if c & 4.
struct Corners {
    std::size_t at[8];
    HWY_INLINE Corners(std::size_t slot, const std::int32_t* rows)
        : at{slot,
             slot + 1,
             slotBeside(slot, rows, 0, kY),
             slotBeside(slot, rows, 1, kY),
             slotBeside(slot, rows, 0, kZ),
             slotBeside(slot, rows, 1, kZ),
             slotBeside(slot, rows, 0, kYZ),
             slotBeside(slot, rows, 1, kYZ)} {}
};

/// One row of F. Differences first: they are exact at rest, and the rest state is exactly the identity.
HWY_INLINE void gradient(Lanes d, const float* HWY_RESTRICT x, const Corners& corners, Vec& a, Vec& b,
                         Vec& c) {
    const Vec p0 = hn::LoadU(d, x + corners.at[0]), p1 = hn::LoadU(d, x + corners.at[1]),
              p2 = hn::LoadU(d, x + corners.at[2]), p3 = hn::LoadU(d, x + corners.at[3]),
              p4 = hn::LoadU(d, x + corners.at[4]), p5 = hn::LoadU(d, x + corners.at[5]),
              p6 = hn::LoadU(d, x + corners.at[6]), p7 = hn::LoadU(d, x + corners.at[7]);
    const Vec quarter = hn::Set(d, 0.25f);
    a = hn::Mul(quarter, hn::Add(hn::Add(hn::Sub(p1, p0), hn::Sub(p3, p2)),
                                 hn::Add(hn::Sub(p5, p4), hn::Sub(p7, p6))));
    b = hn::Mul(quarter, hn::Add(hn::Add(hn::Sub(p2, p0), hn::Sub(p3, p1)),
                                 hn::Add(hn::Sub(p6, p4), hn::Sub(p7, p5))));
    c = hn::Mul(quarter, hn::Add(hn::Add(hn::Sub(p4, p0), hn::Sub(p5, p1)),
                                 hn::Add(hn::Sub(p6, p2), hn::Sub(p7, p3))));
}

HWY_INLINE void cross(Vec ax, Vec ay, Vec az, Vec bx, Vec by, Vec bz, Vec& x, Vec& y, Vec& z) {
    x = hn::MulSub(ay, bz, hn::Mul(az, by));
    y = hn::MulSub(az, bx, hn::Mul(ax, bz));
    z = hn::MulSub(ax, by, hn::Mul(ay, bx));
}

HWY_INLINE Vec square(Vec x, Vec y, Vec z) {
    return hn::MulAdd(z, z, hn::MulAdd(y, y, hn::Mul(x, x)));
}

HWY_INLINE Vec sumOfTwo(Lanes d, const float* HWY_RESTRICT values, std::size_t a, std::size_t b) {
    return hn::Add(hn::LoadU(d, values + a), hn::LoadU(d, values + b));
}

/// The energies of a cell's springs by direction pair, each of constant k, into `sums`.
HWY_INLINE void sumStretches(Lanes d, const CpuCellPass& pass, const Corners& corners,
                             float* HWY_RESTRICT sums) {
    const std::size_t lanes = hn::Lanes(d);
    const std::size_t* at = corners.at;
    const float* const* q = pass.stretches;
    // From the ends at which a spring's direction is even.
    hn::Store(hn::Add(sumOfTwo(d, q[0], at[0], at[2]), sumOfTwo(d, q[0], at[4], at[6])), d, sums);
    hn::Store(hn::Add(sumOfTwo(d, q[1], at[0], at[1]), sumOfTwo(d, q[1], at[4], at[5])), d, sums + lanes);
    hn::Store(hn::Add(sumOfTwo(d, q[2], at[0], at[1]), sumOfTwo(d, q[2], at[2], at[3])), d, sums + 2 * lanes);
    hn::Store(sumOfTwo(d, q[3], at[0], at[4]), d, sums + 3 * lanes);
    hn::Store(sumOfTwo(d, q[4], at[2], at[6]), d, sums + 4 * lanes);
    hn::Store(sumOfTwo(d, q[5], at[0], at[2]), d, sums + 5 * lanes);
    hn::Store(sumOfTwo(d, q[6], at[4], at[6]), d, sums + 6 * lanes);
    hn::Store(sumOfTwo(d, q[7], at[0], at[1]), d, sums + 7 * lanes);
    hn::Store(sumOfTwo(d, q[8], at[4], at[5]), d, sums + 8 * lanes);
}

/// Stress of the curve over that of the springs alone, of each lane's cell. \param volume its volumetric
/// term's energy at a bulk of 1
HWY_INLINE Vec stiffeningOf(Lanes d, const CpuCellPass& pass, std::size_t block, std::size_t slot,
                            const Corners& corners, Vec volume) {
    const Vec one = hn::Set(d, 1.0f);
    if (pass.stiffening[block] == 0)
        return one;
    HWY_ALIGN float sums[9 * kMostLanes];
    const std::size_t lanes = hn::Lanes(d);
    sumStretches(d, pass, corners, sums);
    const auto materials = hn::Load(Words(), pass.material + slot);
    Vec factor = one;
    for (std::uint32_t index = 0, left = pass.stiffening[block]; left != 0; ++index, left >>= 1) {
        if (!(left & 1u))
            continue;
        const CpuCurve& curve = pass.curves[index];
        Vec energy = hn::Mul(hn::Set(d, curve.bulk), volume);
        for (std::size_t pair = 0; pair < 9; ++pair)
            energy = hn::MulAdd(hn::Set(d, curve.spring[pair]), hn::Load(d, sums + pair * lanes), energy);
        energy = hn::Mul(energy, hn::Set(d, curve.twoOverYoung));
        const Vec bend = hn::Set(d, curve.bend), bend3 = hn::Set(d, 3 * curve.bend);
        Vec strain = hn::Sqrt(energy), secant = one;
        for (int i = 0; i < SRS_STRAIN_ITERATIONS; ++i) { // MaterialShares::tensionStrain
            const Vec square = hn::Mul(strain, strain);
            const Vec miss = hn::Sub(hn::MulAdd(bend, hn::Mul(square, strain), square), energy);
            const Vec slope = hn::Mul(strain, hn::MulAdd(bend3, strain, hn::Set(d, 2.0f)));
            strain = hn::Sub(strain, hn::Div(miss, hn::Max(slope, hn::Set(d, 1e-30f))));
        }
        for (int turn = 0; turn < curve.turns; ++turn) {
            const Vec at = hn::Set(d, curve.strain[turn]);
            const Vec more = hn::Mul(hn::Set(d, curve.gain[turn]), hn::Sub(one, hn::Div(at, strain)));
            secant = hn::Add(secant, hn::IfThenElseZero(hn::Gt(strain, at), more));
        }
        secant = hn::Div(secant, hn::MulAdd(hn::Set(d, 1.5f * curve.bend), strain, one));
        factor =
            hn::IfThenElse(hn::RebindMask(d, hn::Eq(materials, hn::Set(Words(), index))), secant, factor);
    }
    return factor;
}

constexpr std::size_t kTileSlots = 128;
constexpr std::size_t kTileStride = kTileSlots + kMostLanes;

/// sum += softened (weight own - w2 second - w3 third)
HWY_INLINE void addSoftened(Vec softened, Vec own, Vec weight, Vec second, Vec w2, Vec third, Vec w3,
                            Vec& sum) {
    const Vec change = hn::NegMulAdd(w3, third, hn::NegMulAdd(w2, second, hn::Mul(weight, own)));
    sum = hn::MulAdd(softened, change, sum);
}

/// One block of cells: the columns of -f dW/dF / 4 to `columns` (nine, kTileStride apart), the
/// stiffened constants to the slots.
template <bool kVolume, bool kStiffens>
HWY_INLINE void cellBlock(Lanes d, const CpuCellPass& pass, std::size_t block, bool writeConstants,
                          float* HWY_RESTRICT columns) {
    const std::size_t slot = pass.first + block * hn::Lanes(d);
    const Corners corners(slot, pass.rows + block * 8);
    const Vec one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    Vec xx = zero, xy = zero, xz = zero, yx = zero, yy = zero, yz = zero, zx = zero, zy = zero, zz = zero;
    Vec volume = zero, factor = one; // energy at a bulk of 1
    Vec change = zero, collapse = zero, q = one, size = one;
    Vec ax = zero, ay = zero, az = zero, bx = zero, by = zero, bz = zero, cx = zero, cy = zero, cz = zero;
    if constexpr (kVolume) {
        gradient(d, pass.positions[0], corners, ax, bx, cx);
        gradient(d, pass.positions[1], corners, ay, by, cy);
        gradient(d, pass.positions[2], corners, az, bz, cz);
        cross(bx, by, bz, cx, cy, cz, xx, xy, xz);
        cross(cx, cy, cz, ax, ay, az, yx, yy, yz);
        cross(ax, ay, az, bx, by, bz, zx, zy, zz);
        const Vec ratio = hn::MulAdd(az, xz, hn::MulAdd(ay, xy, hn::Mul(ax, xx)));
        size = hn::Add(hn::Add(square(xx, xy, xz), square(yx, yy, yz)), square(zx, zy, zz));
        const Vec soft = hn::Min(
            one, hn::Div(hn::Set(d, float(SRS_VOLUME_STIFFENING)), hn::Max(size, hn::Set(d, 1e-12f))));
        q = hn::Mul(soft, soft);
        change = hn::Sub(ratio, one);
        collapse = hn::Max(zero, hn::Sub(hn::Set(d, float(SRS_COLLAPSED)), ratio));
        volume = hn::Mul(hn::Set(d, 0.5f), hn::Mul(hn::Mul(change, change), q));
    }
    if constexpr (kStiffens) {
        if constexpr (kVolume) // none in a cell that a cut runs through
            volume = hn::IfThenElseZero(hn::Gt(hn::Load(d, pass.bulk + slot), zero), volume);
        factor = stiffeningOf(d, pass, block, slot, corners, volume);
        for (int pair = 0; writeConstants && pair < pass.pairs; ++pair)
            hn::Store(hn::Mul(factor, hn::Load(d, pass.constants[pair] + slot)), d,
                      pass.stiffened[pair] + slot);
    }
    if constexpr (kVolume) {
        const Vec bulk = hn::Mul(hn::Load(d, pass.bulk + slot), factor);
        const Vec recovery = hn::Load(d, pass.recovery + slot);
        const Vec share = hn::Mul(hn::Set(d, -0.25f), q);
        const Vec pressure = hn::Mul(share, hn::NegMulAdd(recovery, collapse, hn::Mul(bulk, change)));
        xx = hn::Mul(pressure, xx), xy = hn::Mul(pressure, xy), xz = hn::Mul(pressure, xz);
        yx = hn::Mul(pressure, yx), yy = hn::Mul(pressure, yy), yz = hn::Mul(pressure, yz);
        zx = hn::Mul(pressure, zx), zy = hn::Mul(pressure, zy), zz = hn::Mul(pressure, zz);
        const auto squeezed = hn::Lt(q, one);
        if (!hn::AllFalse(d, squeezed)) { // dq/dF
            const Vec energy =
                hn::MulAdd(hn::Mul(bulk, change), change, hn::Mul(hn::Mul(recovery, collapse), collapse));
            const Vec softened = hn::IfThenElseZero(
                squeezed, hn::Mul(hn::Div(hn::Mul(hn::Set(d, -2.0f), share), size), energy));
            const Vec aa = square(ax, ay, az), bb = square(bx, by, bz), cc = square(cx, cy, cz);
            const Vec ab = hn::MulAdd(az, bz, hn::MulAdd(ay, by, hn::Mul(ax, bx))),
                      bc = hn::MulAdd(bz, cz, hn::MulAdd(by, cy, hn::Mul(bx, cx))),
                      ca = hn::MulAdd(cz, az, hn::MulAdd(cy, ay, hn::Mul(cx, ax)));
            const Vec notA = hn::Add(bb, cc), notB = hn::Add(cc, aa), notC = hn::Add(aa, bb);
            addSoftened(softened, ax, notA, bx, ab, cx, ca, xx);
            addSoftened(softened, ay, notA, by, ab, cy, ca, xy);
            addSoftened(softened, az, notA, bz, ab, cz, ca, xz);
            addSoftened(softened, bx, notB, cx, bc, ax, ab, yx);
            addSoftened(softened, by, notB, cy, bc, ay, ab, yy);
            addSoftened(softened, bz, notB, cz, bc, az, ab, yz);
            addSoftened(softened, cx, notC, ax, ca, bx, bc, zx);
            addSoftened(softened, cy, notC, ay, ca, by, bc, zy);
            addSoftened(softened, cz, notC, az, ca, bz, bc, zz);
        }
        hn::StoreU(xx, d, columns);
        hn::StoreU(xy, d, columns + kTileStride);
        hn::StoreU(xz, d, columns + 2 * kTileStride);
        hn::StoreU(yx, d, columns + 3 * kTileStride);
        hn::StoreU(yy, d, columns + 4 * kTileStride);
        hn::StoreU(yz, d, columns + 5 * kTileStride);
        hn::StoreU(zx, d, columns + 6 * kTileStride);
        hn::StoreU(zy, d, columns + 7 * kTileStride);
        hn::StoreU(zz, d, columns + 8 * kTileStride);
    }
}

/// What the cells at a slot and at the one before it give to the nodes of their four rows at that slot.
HWY_INLINE void storeRowForces(Lanes d, const CpuCellPass& pass, std::size_t slot,
                               const float* HWY_RESTRICT columns) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* x = columns + axis * kTileStride;
        const float* y = x + 3 * kTileStride;
        const float* z = x + 6 * kTileStride;
        // Corners at +x of the cell before, at -x of the cell here.
        const Vec alongX = hn::Sub(hn::LoadU(d, x - 1), hn::LoadU(d, x));
        const Vec alongY = hn::Add(hn::LoadU(d, y - 1), hn::LoadU(d, y));
        const Vec alongZ = hn::Add(hn::LoadU(d, z - 1), hn::LoadU(d, z));
        const Vec sum = hn::Add(alongY, alongZ), difference = hn::Sub(alongZ, alongY);
        hn::Store(hn::Add(alongX, sum), d, pass.rowForces[axis] + slot);            // at +y, +z
        hn::Store(hn::Add(alongX, difference), d, pass.rowForces[3 + axis] + slot); // -y, +z
        hn::Store(hn::Sub(alongX, difference), d, pass.rowForces[6 + axis] + slot); // +y, -z
        hn::Store(hn::Sub(alongX, sum), d, pass.rowForces[9 + axis] + slot);        // -y, -z
    }
}

template <bool kStiffens>
void volumeRange(const CpuCellPass& pass, std::size_t firstBlock, std::size_t lastBlock) {
    const Lanes d;
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN float columns[9 * kTileStride]; // the block before the tile, then the tile
    std::fill_n(columns, 9 * kTileStride, 0.0f);
    if (firstBlock > 0)
        cellBlock<true, kStiffens>(d, pass, firstBlock - 1, false, columns);
    const std::size_t blocksPerTile = kTileSlots / lanes;
    for (std::size_t tile = firstBlock; tile < lastBlock; tile += blocksPerTile) {
        const std::size_t count = std::min(blocksPerTile, lastBlock - tile);
        for (std::size_t i = 0; i < count; ++i)
            cellBlock<true, kStiffens>(d, pass, tile + i, true, columns + (i + 1) * lanes);
        for (std::size_t i = 0; i < count; ++i)
            storeRowForces(d, pass, pass.first + (tile + i) * lanes, columns + (i + 1) * lanes);
        for (std::size_t column = 0; column < 9; ++column)
            columns[column * kTileStride + lanes - 1] =
                columns[column * kTileStride + (count + 1) * lanes - 1];
    }
}

void cellBlocks(const CpuCellPass& pass, std::size_t first, std::size_t last) {
    if (pass.bulk && pass.pairs > 0) {
        volumeRange<true>(pass, first, last);
    } else if (pass.bulk) {
        volumeRange<false>(pass, first, last);
    } else {
        for (std::size_t block = first; block < last; ++block)
            cellBlock<false, true>(Lanes(), pass, block, true, nullptr);
    }
}

} // namespace serosa::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
