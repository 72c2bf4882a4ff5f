#include "render/stf/stf_file.h"

#include "base/content_hash.h"
#include "base/table_file.h"

#include <array>

namespace scree {

namespace {

static_assert(sizeof(ShellExit) == 24 && sizeof(ShellEvent) == 24);

constexpr std::array<char, 8> magic{'S', 'C', 'R', 'E', 'E', 'S', 'T', 'F'};
const std::string what = "shell transport functions";
constexpr uint32_t version = 4; // of the format and of the numbers' meaning: increase it when either changes

struct FileHead {
    std::array<char, 8> magic{};
    uint32_t version = 0, shells = 0;
    uint64_t key = 0;
    uint64_t checksum = 0; // of the shells
};

/// Stands before each shell's exits, exit weights, events and event weights.
struct ShellHead {
    double radius = 0, event_sum = 0;
    uint64_t exits = 0, events = 0;
};

template <class Shell, class Each>
void for_each_part(Shell& shell, const Each& each)
{
    for_each_block(each, shell.exits, shell.exit_weights, shell.events, shell.event_weights);
}

uint64_t checksum_of(const ShellHead& head, const StfShell& shell, uint64_t hash)
{
    hash = hash_bytes(&head, sizeof head, hash);
    for_each_part(shell, [&](const void* bytes, size_t size) { hash = hash_bytes(bytes, size, hash); });
    return hash;
}

ShellHead head_of(const StfShell& shell)
{
    return {shell.radius, shell.event_sum, shell.exits.size(), shell.events.size()};
}

} // namespace

void write_stf(const std::filesystem::path& file, const Stf& stf, uint64_t key)
{
    FileHead head{magic, version, static_cast<uint32_t>(stf.shells.size()), key, version};
    std::vector<ShellHead> heads;
    for (const StfShell& shell : stf.shells) {
        heads.push_back(head_of(shell));
        head.checksum = checksum_of(heads.back(), shell, head.checksum);
    }
    TableFileWriter writer(file, what);
    writer.add(head);
    for (size_t i = 0; i < heads.size(); ++i) {
        writer.add(heads[i]);
        for_each_part(stf.shells[i], [&](const void* bytes, size_t size) { writer.add(bytes, size); });
    }
    writer.write();
}

void read_stf(const std::filesystem::path& file, uint64_t key, Stf& stf)
{
    TableFileReader reader(file, what);
    const auto head = reader.read<FileHead>();
    if (head.magic != magic) throw reader.refuse("a file of another kind");
    if (head.version != version) throw reader.refuse("a file of another version");
    if (head.key != key) throw reader.refuse("shells of another medium");
    std::vector<StfShell> shells;
    uint64_t checksum = version;
    for (uint32_t i = 0; i < head.shells; ++i) {
        const auto of_shell = reader.read<ShellHead>();
        constexpr uint64_t most = uint64_t{1} << 20; // the builder's limit
        if (of_shell.exits == 0 || of_shell.events == 0 || of_shell.exits > most || of_shell.events > most ||
            of_shell.radius != Stf::radius(i))
            throw reader.refuse("a damaged file: an impossible shell");
        StfShell shell;
        shell.radius = of_shell.radius;
        shell.event_sum = of_shell.event_sum;
        shell.exits.resize(of_shell.exits);
        shell.exit_weights.resize(of_shell.exits);
        shell.events.resize(of_shell.events);
        shell.event_weights.resize(of_shell.events);
        for_each_part(shell, [&](void* bytes, size_t size) { reader.read(bytes, size); });
        checksum = checksum_of(of_shell, shell, checksum);
        shells.push_back(std::move(shell));
    }
    reader.finish(checksum, head.checksum);
    stf.shells = std::move(shells);
}

} // namespace scree
