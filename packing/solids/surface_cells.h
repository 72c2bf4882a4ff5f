#pragma once

#include "packing/solids/domain.h"
#include "packing/solids/exact_distance.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

/// Decides whether small balls lie wholly inside a domain; it stores the few triangles near each cell of a cubic grid.
///
/// A cell is filled at the first question about a ball in it. The answer is always that of Domain::contains_sphere:
/// planes in float with proven error bounds decide nearly all questions, triangles in double most of the others, and
/// the domain the rest. Any thread may ask.
class SurfaceCells {
public:
    /// largest: the largest radius that will be asked about; it sets the size of cells. The domain must outlive this.
    SurfaceCells(const Domain& domain, double largest);
    ~SurfaceCells();
    SurfaceCells(const SurfaceCells&) = delete;
    SurfaceCells& operator=(const SurfaceCells&) = delete;

    /// Centre finite, 0 < radius <= largest.
    bool contains_sphere(const Imath::V3d& centre, double radius) const;

    uint64_t bytes() const;
    /// How many questions needed the domain's answer.
    uint64_t domain_tests() const { return domain_tests_.load(); }

private:
    struct Cell;
    struct Plate;
    enum class Answer : uint8_t { no, yes, unknown };

    const Cell* find(uint64_t key) const;
    std::unique_ptr<Cell> make(uint64_t key) const;
    Imath::V3d middle(uint64_t key) const;
    Corners corners(uint32_t face) const;
    /// A lower bound on the scaled distance from the place to the triangle; least: another lower bound.
    double lower_bound(const Plate& plate, const Imath::V3d& place, double least) const;
    Answer ask(const Cell& cell, const Imath::V3d& offset, const Imath::V3d& centre, double radius) const;

    const Domain& domain_;
    double scale_ = 1; // power of two that scales the bounds' longest edge to 1/2..1
    double edge_ = 0; // of a cell; 0 where there are no cells
    double half_ = 0; // half of a cell's diagonal, slightly enlarged
    double largest_;
    float error_ = 0; // bound on the errors of what is computed in float; scaled
    std::vector<Plate> plates_; // by face
    // A hash table of cells by key, with open addressing; null where a slot is empty.
    std::unique_ptr<std::atomic<const Cell*>[]> slots_;
    mutable std::atomic<uint64_t> bytes_{0}, domain_tests_{0};
};

} // namespace scree
