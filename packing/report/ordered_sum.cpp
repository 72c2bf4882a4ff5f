#include "packing/report/ordered_sum.h"

#include "base/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>

namespace scree {

void for_chunks(uint64_t count, uint64_t size, const std::string& stage, const Progress& progress,
                const std::function<void(uint64_t chunk, uint64_t begin, uint64_t end)>& work)
{
    const uint64_t chunks = (count + size - 1) / size;
    std::atomic<uint64_t> done{0};
    std::mutex telling;
    progress.update(stage, 0);
    tbb::parallel_for(uint64_t{0}, chunks, [&](uint64_t chunk) {
        if (progress.cancelled()) return;
        work(chunk, chunk * size, std::min(count, (chunk + 1) * size));
        const uint64_t finished = ++done;
        // A thread need not wait while another thread reports progress.
        const std::unique_lock<std::mutex> lock(telling, std::try_to_lock);
        if (lock) progress.update(stage, double(finished) / double(chunks));
    });
    if (progress.cancelled()) throw Cancelled();
    progress.update(stage, 1);
}

} // namespace scree
