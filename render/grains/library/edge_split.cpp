#include "render/grains/library/edge_split.h"

#include <limits>
#include <queue>
#include <unordered_map>

namespace scree {

namespace {

using Imath::V3d;

constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

struct QueuedEdge {
    double length2;
    uint64_t age;
    uint32_t a, b;

    bool operator<(const QueuedEdge& other) const
    {
        return length2 != other.length2 ? length2 < other.length2 : age > other.age;
    }
};

/// The mesh with its edges. The forward face of an edge runs along it from the lower to the higher vertex.
class Splitter {
public:
    explicit Splitter(TriangleMesh& mesh) : mesh_(mesh)
    {
        edges_.reserve(3 * mesh.triangles.size());
        for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
            const auto t = mesh.triangles[f];
            for (size_t i = 0; i < 3; ++i) {
                const uint32_t a = t[i], b = t[(i + 1) % 3];
                const bool known = edges_.contains(key(a, b));
                face_of(a, b) = f;
                if (!known) push(a, b);
            }
        }
    }

    void split(const std::function<V3d(const V3d&)>& place)
    {
        const auto [length2, age, a, b] = queue_.top();
        queue_.pop();
        const Faces faces = edges_.at(key(a, b));
        edges_.erase(key(a, b));
        const auto m = static_cast<uint32_t>(mesh_.positions.size());
        mesh_.positions.push_back(place(0.5 * (mesh_.positions[a] + mesh_.positions[b])));
        split_face(faces.forward, a, b, m);
        split_face(faces.backward, b, a, m);
        push(a, m);
        push(m, b);
    }

private:
    struct Faces {
        uint32_t forward = none, backward = none;
    };

    static uint64_t key(uint32_t a, uint32_t b)
    {
        return (static_cast<uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
    }
    uint32_t& face_of(uint32_t a, uint32_t b)
    {
        Faces& faces = edges_[key(a, b)];
        return a < b ? faces.forward : faces.backward;
    }
    void push(uint32_t a, uint32_t b)
    {
        queue_.push({(mesh_.positions[a] - mesh_.positions[b]).length2(), age_++, std::min(a, b), std::max(a, b)});
    }

    /// Face (a, b, c) becomes (a, m, c), and (m, b, c) is new.
    void split_face(uint32_t face, uint32_t a, uint32_t b, uint32_t m)
    {
        if (face == none) return;
        const auto t = mesh_.triangles[face];
        const uint32_t c = t[0] != a && t[0] != b ? t[0] : t[1] != a && t[1] != b ? t[1] : t[2];
        const auto added = static_cast<uint32_t>(mesh_.triangles.size());
        mesh_.triangles[face] = {a, m, c};
        mesh_.triangles.push_back({m, b, c});
        face_of(a, m) = face;
        face_of(m, b) = added;
        face_of(b, c) = added;
        face_of(m, c) = face;
        face_of(c, m) = added;
        push(m, c);
    }

    TriangleMesh& mesh_;
    std::unordered_map<uint64_t, Faces> edges_;
    std::priority_queue<QueuedEdge> queue_;
    uint64_t age_ = 0;
};

} // namespace

void split_longest_edges(TriangleMesh& mesh, uint64_t splits, const std::function<V3d(const V3d&)>& place)
{
    if (splits == 0) return;
    Splitter splitter(mesh);
    for (uint64_t i = 0; i < splits; ++i) splitter.split(place);
}

} // namespace scree
