#pragma once
// The heart's chambers and great vessels as signed distance functions. Millimetres, in the viewer's frame: y
// up, seen from +z as in an anterior view, so +x is the patient's left.
//
// Each chamber is a cavity, and its wall is that cavity grown by the wall's thickness: walls are true by
// construction. Where two cavities are neighbours, the one with the thinner wall gives way to the other's
// wall (the septum belongs to the left ventricle, the interatrial septum to the left atrium). Valves are
// shut: every lumen is apart from the others.

#include "models/tube.h"

#include <vector>

namespace serosa::models {

struct HeartWalls {
    static constexpr double kLeftVentricle = 9.0, kRightVentricle = 4.0, kAtrium = 2.5, kVessel = 2.0;
    static constexpr double kValve = 3.5; // shut leaflets with their ring
};

class HeartAnatomy {
public:
    HeartAnatomy();

    enum Part {
        leftVentricle,
        rightVentricle,
        leftAtrium,
        rightAtrium,
        aorta,
        pulmonary,
        cavae,
        veins,
        kParts
    };
    struct Distances {
        double outer[kParts];
        double lumen[kParts];
        double fat;
    };
    Distances distances(const Point& p) const;

    /// Outer surface of muscle and vessels, before coronaries; and muscle alone.
    static double outside(const Distances& d);
    static double muscle(const Distances& d);
    static double ventricles(const Distances& d);
    /// Nearest lumen.
    static double lumens(const Distances& d);

    /// Heart-axis frame: +y from apex to base along the long axis, origin between the atrioventricular
    /// valves.
    Point toLocal(const Point& p) const { return p * worldFromLocal_; }
    Point toWorld(const Point& local) const { return worldFromLocal_ * local; }

private:
    struct Vessel {
        Tube outer, lumen;
    };
    Vessel vessel(const std::vector<TubePoint>& lumen, Tube::End start, Tube::End finish) const;
    static double outerOf(const std::vector<Vessel>& vessels, const Point& p, double k);
    static double lumenOf(const std::vector<Vessel>& vessels, const Point& p, double k);

    glm::dmat3 worldFromLocal_;
    std::vector<Vessel> aorta_, pulmonary_, cavae_, veins_;
    std::vector<Tube> conus_, leftAuricle_, rightAuricle_;
};

} // namespace serosa::models
