#pragma once

#include "base/progress.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace scree {

/// Runs work(chunk, begin, end) over 0..count in parallel, in chunks of `size` on any number of threads.
/// Throws Cancelled.
void for_chunks(uint64_t count, uint64_t size, const std::string& stage, const Progress& progress,
                const std::function<void(uint64_t chunk, uint64_t begin, uint64_t end)>& work);

/// Sums what work(begin, end) returns for the chunks of 0..count, by State::add in the order of the chunks: the same to
/// the last bit on any number of threads. Throws Cancelled.
template <class State, class Work>
State ordered_sum(uint64_t count, uint64_t size, const std::string& stage, const Progress& progress, const Work& work)
{
    std::vector<State> parts((count + size - 1) / size);
    for_chunks(count, size, stage, progress,
               [&](uint64_t chunk, uint64_t begin, uint64_t end) { parts[chunk] = work(begin, end); });
    State sum;
    for (State& part : parts) {
        sum.add(part);
        part = State(); // states may be large: free each one as soon as it is added
    }
    return sum;
}

} // namespace scree
