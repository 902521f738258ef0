// The list of phantoms.
#include "models/phantom.h"

#include "models/dragon.h"
#include "models/heart.h"
#include "models/simple_shapes.h"

#include <algorithm>

namespace serosa::models {
namespace {

/// Number of single-letter edits between two words.
std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
            diagonal = above;
        }
    }
    return row[b.size()];
}

} // namespace

const std::vector<PhantomInfo>& phantoms() {
    static const std::vector<PhantomInfo> list = {
        {"heart", "adult heart: four chambers with true walls, great vessels, coronaries; 120 mm of muscle",
         50000},
        {"dragon", "curled dragon, 120 x 120 x 60 mm, for figure 6 of MS05", 10000},
        {"beam", "box of 30 x 30 x 120 mm with sharp edges", 3600},
        {"ball", "ball of radius 40 mm", 5120},
    };
    return list;
}

Result<sim::TriangleMesh> makePhantom(const std::string& name, std::size_t faces) {
    if (faces < 4)
        return Error{"a closed surface has at least 4 faces, not " + std::to_string(faces)};
    if (name == "heart")
        return makeHeart(faces);
    if (name == "dragon")
        return makeDragon(faces);
    if (name == "beam")
        return makeBeam(faces);
    if (name == "ball")
        return makeBall(faces);
    std::string all, nearest;
    for (const PhantomInfo& info : phantoms()) {
        all += (all.empty() ? "" : ", ") + info.name;
        if (nearest.empty() || editDistance(name, info.name) < editDistance(name, nearest))
            nearest = info.name;
    }
    return Error{"no phantom is named \"" + name + "\"; did you mean \"" + nearest + "\"? There are: " + all};
}

} // namespace serosa::models
