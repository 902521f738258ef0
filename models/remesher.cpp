// Collapse, flip, relax, as in Botsch & Kobbelt 2004, A remeshing approach to multiresolution modeling
// (section 4), with two changes: there is no split, since marching tetrahedra start too fine everywhere, and
// the shortest edge goes first until the face count is right, where they compare each edge with one length.
#include "models/remesher.h"

#include "base/check.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <array>
#include <queue>

namespace serosa::models {
namespace {

struct Traits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Vertex = OpenMesh::VertexHandle;
using Edge = OpenMesh::EdgeHandle;
using Halfedge = OpenMesh::HalfedgeHandle;

constexpr double kOnSurface = 2e-7; // mm
constexpr double kTurned = 0.25;    // least cosine between a face and the gradients at its corners
constexpr double kLongest = 1.9;    // longest edge that a collapse may make, in wanted lengths
constexpr double kGoodAngle = 0.45; // rad (26 degrees): above it, angles need not improve
constexpr double kFairAngle = 0.35; // rad (20 degrees): a collapse may lower the least angle to this
constexpr double kPoorAngle = 0.26; // rad (15 degrees): below it, a face is worth a collapse of its own

double leastAngle(const Point& a, const Point& b, const Point& c) {
    const auto angle = [](const Point& u, const Point& v) {
        return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
    };
    return std::min({angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)});
}

class Remesher {
public:
    Remesher(const sim::TriangleMesh& input, const MeshSource& source) : source_(source) {
        mesh_.reserve(input.positions.size(), input.faces.size() * 3 / 2, input.faces.size());
        for (const Point& p : input.positions)
            mesh_.add_vertex({0, 0, 0}), at_.push_back(p);
        for (const glm::uvec3& f : input.faces) {
            const auto added = mesh_.add_face(Vertex(static_cast<int>(f.x)), Vertex(static_cast<int>(f.y)),
                                              Vertex(static_cast<int>(f.z)));
            SEROSA_CHECK(added.is_valid(), "marching tetrahedra gave a face that is not manifold");
        }
        faces_ = input.faces.size();
        // The first normals are the mesh's own; the gradient replaces them as vertices are projected.
        normal_.assign(at_.size(), Point(0));
        for (const glm::uvec3& f : input.faces) {
            const Point n = glm::cross(at_[f.y] - at_[f.x], at_[f.z] - at_[f.x]);
            for (int k = 0; k < 3; ++k)
                normal_[f[k]] += n;
        }
        for (const Point& p : at_)
            size_.push_back(sizeAt(p));
        for (Point& n : normal_)
            n = glm::normalize(n + Point(0, 0, 1e-300));
        stamp_.resize(at_.size());
    }

    sim::TriangleMesh run(std::size_t target) {
        const std::size_t spare = target + target / 150 + 8;
        // Far above the wanted count, edges are so short that a new vertex need not be projected at once.
        draft_ = true;
        collapseTo(std::max(spare, target * 9 / 5));
        draft_ = false;
        flip();
        relax();
        for (const std::size_t count : {std::max(spare, target * 5 / 4), spare, spare, spare}) {
            if (faces_ <= count)
                continue;
            collapseTo(count);
            flip();
            relax();
        }
        for (int round = 0; round < 3; ++round) {
            removePoor(target);
            flip();
            relax();
        }
        settle();
        return result();
    }

private:
    const Point& at(Vertex v) const { return at_[static_cast<std::size_t>(v.idx())]; }
    double sizeAt(const Point& p) const { return source_.size ? source_.size(p) : 1.0; }

    /// Moves p onto the zero set by Newton steps along the gradient, which it returns normalized.
    bool project(Point& p, Point& normal) const {
        constexpr double e = 1e-4;
        for (int step = 0; step < 8; ++step) {
            const double d = source_.distance(p);
            if (step > 0 && std::abs(d) < kOnSurface)
                return true;
            if (step < 2 || step == 5) {
                const Point g =
                    Point(source_.distance(p + Point(e, 0, 0)) - d, source_.distance(p + Point(0, e, 0)) - d,
                          source_.distance(p + Point(0, 0, e)) - d) /
                    e;
                const double length = glm::length(g);
                if (length < 0.2)
                    return false;
                slope_ = length;
                normal = g / length;
            }
            p -= std::clamp(d / slope_, -2.0, 2.0) * normal;
        }
        return std::abs(source_.distance(p)) < 5 * kOnSurface;
    }

    /// Is the face a, b, c turned as the gradients at its corners are?
    static bool turned(const Point& a, const Point& b, const Point& c, const Point& na, const Point& nb,
                       const Point& nc) {
        const Point n = glm::cross(b - a, c - a);
        const double least = kTurned * glm::length(n);
        return glm::dot(n, na) > least && glm::dot(n, nb) > least && glm::dot(n, nc) > least;
    }

    /// Quality of the faces around `v`, were it at p with normal n: their least angle, or minus the number of
    /// faces that are turned over (slivers from the first stage may be). Faces that hold `without` are left
    /// out.
    double fan(Vertex v, const Point& p, const Point& n, Vertex without) const {
        double least = 4;
        int over = 0;
        for (auto h = mesh_.cvoh_iter(v); h.is_valid(); ++h) {
            const Vertex b = mesh_.to_vertex_handle(*h);
            const Vertex c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(*h));
            if (b == without || c == without)
                continue;
            if (!turned(p, at(b), at(c), n, normal(b), normal(c)))
                ++over;
            least = std::min(least, leastAngle(p, at(b), at(c)));
        }
        return over > 0 ? -over : least;
    }
    static double both(double a, double b) { return a < 0 && b < 0 ? a + b : std::min(a, b); }
    const Point& normal(Vertex v) const { return normal_[static_cast<std::size_t>(v.idx())]; }
    double size(Vertex v) const { return size_[static_cast<std::size_t>(v.idx())]; }

    double relativeLength(Edge e) const {
        const Halfedge h = mesh_.halfedge_handle(e, 0);
        const Vertex a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
        return 2 * glm::length(at(a) - at(b)) / (size(a) + size(b));
    }

    /// Wanted edge length for `target` equilateral faces, in units of source.size.
    double wantedLength(std::size_t target) const {
        double weighted = 0;
        for (auto f : mesh_.faces()) {
            auto v = mesh_.cfv_iter(f);
            const Vertex a = *v++, b = *v++, c = *v;
            const double s = (size(a) + size(b) + size(c)) / 3;
            weighted += 0.5 * glm::length(glm::cross(at(b) - at(a), at(c) - at(a))) / (s * s);
        }
        return std::sqrt(weighted / static_cast<double>(target) * 4 / std::sqrt(3.0));
    }

    /// Collapses e onto its projected middle or, failing that, onto one of its ends.
    bool tryCollapse(Edge e, double wanted) {
        const Halfedge h = mesh_.halfedge_handle(e, 0);
        const Vertex gone = mesh_.from_vertex_handle(h), kept = mesh_.to_vertex_handle(h);
        if (!mesh_.is_collapse_ok(h))
            return false;
        const double before =
            both(fan(gone, at(gone), normal(gone), Vertex()), fan(kept, at(kept), normal(kept), gone));
        // Very short edges make thin faces wherever they are: be content with less to be rid of them.
        const double least = relativeLength(e) < 0.35 * wanted ? std::min(0.5 * before, 0.12) : before;
        const auto place = [&](const Point& p, const Point& n) {
            const double s = draft_ ? 0.5 * (size(gone) + size(kept)) : sizeAt(p);
            for (const Vertex v : {gone, kept})
                for (auto w = mesh_.cvv_iter(v); w.is_valid(); ++w)
                    if (*w != gone && *w != kept &&
                        2 * glm::length(at(*w) - p) / (s + size(*w)) > kLongest * wanted)
                        return false;
            const double after = both(fan(gone, p, n, kept), fan(kept, p, n, gone));
            if (after < kFairAngle && after < least)
                return false;
            mesh_.collapse(h);
            faces_ -= 2;
            const auto i = static_cast<std::size_t>(kept.idx());
            at_[i] = p;
            normal_[i] = n;
            size_[i] = s;
            ++stamp_[i];
            return true;
        };
        Point p = 0.5 * (at(gone) + at(kept)), n = normal(kept);
        const Point middle = p;
        if (draft_ && place(p, glm::normalize(normal(gone) + normal(kept))))
            return true;
        if (!draft_ && project(p, n) && glm::length(p - middle) < 0.5 * wanted && place(p, n))
            return true;
        return place(Point(at(kept)), Point(normal(kept))) || place(Point(at(gone)), Point(normal(gone)));
    }

    void collapseTo(std::size_t target) {
        if (faces_ <= target)
            return;
        const double wanted = wantedLength(target);
        struct Candidate {
            double length;
            int edge;
            unsigned stamp;
        };
        const auto later = [](const Candidate& a, const Candidate& b) {
            return a.length != b.length ? a.length > b.length : a.edge > b.edge;
        };
        std::priority_queue<Candidate, std::vector<Candidate>, decltype(later)> queue(later);
        const auto stampOf = [&](Edge e) {
            const Halfedge h = mesh_.halfedge_handle(e, 0);
            return stamp_[static_cast<std::size_t>(mesh_.from_vertex_handle(h).idx())] +
                   stamp_[static_cast<std::size_t>(mesh_.to_vertex_handle(h).idx())];
        };
        for (auto e : mesh_.edges())
            queue.push({relativeLength(e), e.idx(), stampOf(e)});
        while (faces_ > target && !queue.empty()) {
            const Candidate c = queue.top();
            queue.pop();
            const Edge e(c.edge);
            if (mesh_.status(e).deleted() || stampOf(e) != c.stamp)
                continue;
            const Vertex kept = mesh_.to_vertex_handle(mesh_.halfedge_handle(e, 0));
            if (tryCollapse(e, wanted))
                for (auto next = mesh_.cve_iter(kept); next.is_valid(); ++next)
                    queue.push({relativeLength(*next), next->idx(), stampOf(*next)});
        }
    }

    /// Flips every edge whose flip raises the least angle of its two faces.
    void flip() {
        for (int sweep = 0; sweep < 2; ++sweep)
            for (auto e : mesh_.edges()) {
                const Halfedge h = mesh_.halfedge_handle(e, 0), o = mesh_.halfedge_handle(e, 1);
                const Vertex a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
                const Vertex c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
                const Vertex d = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(o));
                const double before =
                    std::min(leastAngle(at(a), at(b), at(c)), leastAngle(at(a), at(b), at(d)));
                const double after =
                    std::min(leastAngle(at(a), at(d), at(c)), leastAngle(at(b), at(c), at(d)));
                if (after <= before + 1e-6 || !mesh_.is_flip_ok(e))
                    continue;
                if (turned(at(a), at(d), at(c), normal(a), normal(d), normal(c)) &&
                    turned(at(b), at(c), at(d), normal(b), normal(c), normal(d)))
                    mesh_.flip(e);
            }
    }

    /// Moves each vertex towards the weighted centre of its faces, along the surface.
    void relax() {
        for (auto v : mesh_.vertices()) {
            Point sum(0);
            double weight = 0;
            for (auto h = mesh_.cvoh_iter(v); h.is_valid(); ++h) {
                const Vertex b = mesh_.to_vertex_handle(*h);
                const Vertex c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(*h));
                const double s = (size(v) + size(b) + size(c)) / 3;
                const double w = glm::length(glm::cross(at(b) - at(v), at(c) - at(v))) / (s * s);
                sum += w * (at(v) + at(b) + at(c)) / 3.0;
                weight += w;
            }
            Point move = sum / weight - at(v);
            move -= glm::dot(move, normal(v)) * normal(v);
            Point p = at(v) + move, n;
            if (!project(p, n))
                continue;
            const double after = fan(v, p, n, Vertex());
            if (after < kGoodAngle && after < fan(v, at(v), normal(v), Vertex()))
                continue;
            const auto i = static_cast<std::size_t>(v.idx());
            at_[i] = p;
            normal_[i] = n;
            size_[i] = sizeAt(p);
        }
    }

    /// Collapses the shortest edge of each face with a poor angle, as long as more than `target` faces are
    /// left.
    void removePoor(std::size_t target) {
        const double wanted = 1.3 * wantedLength(target);
        for (auto f : mesh_.faces()) {
            if (faces_ <= target + 1)
                return;
            if (mesh_.status(f).deleted())
                continue;
            auto v = mesh_.cfv_iter(f);
            const Vertex a = *v++, b = *v++, c = *v;
            if (leastAngle(at(a), at(b), at(c)) > kPoorAngle)
                continue;
            std::array<Edge, 3> edges;
            std::size_t count = 0;
            for (auto e = mesh_.cfe_iter(f); e.is_valid(); ++e)
                edges[count++] = *e;
            std::sort(edges.begin(), edges.end(),
                      [&](Edge x, Edge y) { return relativeLength(x) < relativeLength(y); });
            if (!tryCollapse(edges[0], wanted))
                tryCollapse(edges[1], wanted);
        }
    }

    /// Projects what no accepted move has projected yet.
    void settle() {
        for (auto v : mesh_.vertices()) {
            const auto i = static_cast<std::size_t>(v.idx());
            if (std::abs(source_.distance(at_[i])) < 5 * kOnSurface)
                continue;
            Point p = at_[i], n;
            if (project(p, n) && glm::length(p - at_[i]) < 0.5) {
                at_[i] = p;
                normal_[i] = n;
            }
        }
    }

    sim::TriangleMesh result() const {
        sim::TriangleMesh out;
        std::vector<std::uint32_t> number(at_.size());
        for (auto v : mesh_.vertices()) {
            number[static_cast<std::size_t>(v.idx())] = static_cast<std::uint32_t>(out.positions.size());
            out.positions.push_back(at(v));
        }
        for (auto f : mesh_.faces()) {
            glm::uvec3 corners;
            int k = 0;
            for (auto v = mesh_.cfv_iter(f); v.is_valid(); ++v)
                corners[k++] = number[static_cast<std::size_t>(v->idx())];
            out.faces.push_back(corners);
        }
        return out;
    }

    const MeshSource& source_;
    HalfedgeMesh mesh_;
    std::vector<Point> at_, normal_;
    std::vector<double> size_;
    std::vector<unsigned> stamp_;
    std::size_t faces_ = 0;
    mutable double slope_ = 1;
    bool draft_ = false;
};

} // namespace

sim::TriangleMesh remesh(const sim::TriangleMesh& mesh, const MeshSource& source, std::size_t faces) {
    return Remesher(mesh, source).run(faces);
}

} // namespace serosa::models
