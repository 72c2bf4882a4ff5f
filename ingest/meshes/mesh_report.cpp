#include "ingest/meshes/mesh_topology.h"
#include "ingest/meshes/self_intersections.h"
#include "ingest/meshes/triangle_mesh.h"

namespace scree {

MeshReport report_mesh(const TriangleMesh& mesh)
{
    MeshReport report;
    report.vertices = mesh.positions.size();
    report.faces = mesh.triangles.size();
    if (mesh.triangles.empty()) return report;
    const MeshTopology topology = topology_of(mesh);
    report.closed = topology.closed;
    report.oriented = topology.oriented;
    report.self_intersections = find_self_intersections(mesh).pairs;
    report.volume = signed_volume(mesh);
    const Imath::Box3d bounds = bounds_of(mesh);
    report.lo = bounds.min;
    report.hi = bounds.max;
    return report;
}

} // namespace scree
