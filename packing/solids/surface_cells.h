#pragma once

#include "packing/solids/domain.h"
#include "packing/solids/exact_distance.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

/// Answers whether small balls are whole inside a domain from the few triangles near them, which it keeps by cubic
/// cells.
///
/// A cell is filled when a ball is first asked about in it. The answer is Domain::contains_sphere's: planes in float
/// with proven bounds settle nearly all, triangles in double most of the others, and the domain the rest. Any thread
/// may ask.
class SurfaceCells {
public:
    /// largest: of the radii that will be asked about; cells are made for it. The domain must outlive this.
    SurfaceCells(const Domain& domain, double largest);
    ~SurfaceCells();
    SurfaceCells(const SurfaceCells&) = delete;
    SurfaceCells& operator=(const SurfaceCells&) = delete;

    /// Centre finite, 0 < radius <= largest.
    bool contains_sphere(const Imath::V3d& centre, double radius) const;

    uint64_t bytes() const;
    /// How many times the domain had to be asked.
    uint64_t domain_tests() const { return domain_tests_.load(); }

private:
    struct Cell;
    struct Plate;
    enum class Answer : uint8_t { no, yes, unknown };

    const Cell* find(uint64_t key) const;
    std::unique_ptr<Cell> make(uint64_t key) const;
    Imath::V3d middle(uint64_t key) const;
    Corners corners(uint32_t face) const;
    /// Of the distance of the place from the triangle, scaled; least: another one.
    double lower_bound(const Plate& plate, const Imath::V3d& place, double least) const;
    Answer ask(const Cell& cell, const Imath::V3d& offset, const Imath::V3d& centre, double radius) const;

    const Domain& domain_;
    double scale_ = 1; // power of two that brings the bounds' longest edge to 1/2..1
    double edge_ = 0; // of a cell; 0 where there are none
    double half_ = 0; // of a cell's diagonal, and a little more
    double largest_;
    float error_ = 0; // of what is computed in float; scaled
    std::vector<Plate> plates_; // by face
    // By a hash of the key, open addressing; null where there is none yet.
    std::unique_ptr<std::atomic<const Cell*>[]> slots_;
    mutable std::atomic<uint64_t> bytes_{0}, domain_tests_{0};
};

} // namespace scree
