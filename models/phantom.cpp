// The list of phantoms.
#include "models/phantom.h"

#include "models/apple.h"
#include "models/bank.h"
#include "models/coins.h"
#include "models/dragon.h"
#include "models/fish.h"
#include "models/golf_ball.h"
#include "models/hand.h"
#include "models/heart.h"
#include "models/kidney.h"
#include "models/liver.h"
#include "models/mask.h"
#include "models/simple_shapes.h"
#include "models/skin.h"
#include "models/torso.h"
#include "sim/suggest.h"

namespace serosa::models {
namespace {

using Maker = Result<sim::TriangleMesh> (*)(std::size_t faces);

using SolidOf = const Solid& (*)();

struct Phantom {
    PhantomInfo info;
    Maker make;
    SolidOf solid = nullptr; // where its inside is known
};

/// A new phantom is a line here, and a file of its own.
const std::vector<Phantom>& table() {
    static const std::vector<Phantom> list = {
        {{"heart", "adult heart: four chambers with true walls, great vessels, coronaries; 120 mm of muscle",
          50000},
         makeHeart},
        {{"liver", "liver with gallbladder, ligament and the vessels' stumps; 200 mm wide", 60000},
         makeLiver,
         liverSolid},
        {{"kidney", "right kidney, 110 mm high, with renal artery, vein and ureter", 40000},
         makeKidney,
         kidneySolid},
        {{"skin", "patch of skin, 80 x 80 x 20 mm: epidermis, dermis, fat, muscle", 100000},
         makeSkin,
         skinSolid},
        {{"dragon", "curled dragon, 120 x 120 x 60 mm, for figure 6 of MS05", 10000}, makeDragon},
        {{"golfball", "golf ball with 336 dimples, for figure 3 of CS07", 245000}, makeGolfBall},
        {{"apple", "apple with stem and calyx, 76 mm wide, for figures 2 and 6 of CS07", 40000},
         makeApple,
         []() -> const Solid& { return appleSolid(); }},
        {{"bank", "hollow piggy bank with a coin slot, walls of 4 mm, for figures 1 and 4 of CSC06", 40000},
         makeBank},
        {{"coins", "heap of 26 coins, fused where they touch, that lies in the bank", 80000}, makeCoins},
        {{"fish", "perch with fins spread, 186 mm long, for the figures of CS07", 60000}, makeFish},
        {{"hand", "open right hand, 188 mm from wrist to fingertip, for the figures of CS07", 60000},
         makeHand,
         handSolid},
        {{"torso", "trunk of a man, 600 mm high, whose chest CS07 peels in figure 1", 25000},
         makeTorso,
         torsoSolid},
        {{"mask", "face mask that lies under the skin of the torso's chest", 10000}, makeMask},
        {{"beam", "box of 30 x 30 x 120 mm with sharp edges", 3600}, makeBeam},
        {{"layer", "flat layer, 120 x 48 x 120 mm with sharp edges, to be indented", 11520}, makeLayer},
        {{"ball", "ball of radius 40 mm", 5120}, makeBall},
    };
    return list;
}

Result<const Phantom*> find(const std::string& name) {
    std::vector<std::string> names;
    for (const Phantom& phantom : table()) {
        if (phantom.info.name == name)
            return &phantom;
        names.push_back(phantom.info.name);
    }
    std::string all;
    for (const std::string& known : names)
        all += (all.empty() ? "" : ", ") + known;
    const std::string near = sim::nearestWord(name, names);
    return Error{"no phantom is named \"" + name + "\"" +
                 (near.empty() ? "" : "; did you mean \"" + near + "\"?") + "; there are: " + all};
}

} // namespace

const std::vector<PhantomInfo>& phantoms() {
    static const std::vector<PhantomInfo> list = [] {
        std::vector<PhantomInfo> infos;
        for (const Phantom& phantom : table())
            infos.push_back(phantom.info);
        return infos;
    }();
    return list;
}

Result<sim::TriangleMesh> makePhantom(const std::string& name, std::size_t faces) {
    if (faces < 4)
        return Error{"a closed surface has at least 4 faces, not " + std::to_string(faces)};
    SEROSA_ASSIGN(const Phantom* phantom, find(name));
    return phantom->make(faces);
}

Result<ColourVolume> makePhantomVolume(const std::string& name, double voxel) {
    SEROSA_ASSIGN(const Phantom* phantom, find(name));
    if (!phantom->solid) {
        std::string known;
        for (const Phantom& other : table())
            if (other.solid)
                known += (known.empty() ? "" : ", ") + other.info.name;
        return Error{"the " + name + " phantom has no inside to sample; these have: " + known};
    }
    return sampleSolid(phantom->solid(), voxel);
}

Result<sim::TriangleMesh> phantomInMetres(const std::string& name, std::size_t faces) {
    SEROSA_ASSIGN(sim::TriangleMesh mesh, makePhantom(name, faces));
    for (glm::dvec3& position : mesh.positions)
        position *= 1e-3;
    return mesh;
}

Result<sim::Lattice> phantomLattice(const std::string& name, std::size_t faces, std::size_t nodes) {
    SEROSA_ASSIGN(const sim::TriangleMesh mesh, phantomInMetres(name, faces));
    sim::LatticeRequest request;
    request.nodes = nodes;
    return sim::buildLattice(mesh, request);
}

} // namespace serosa::models
