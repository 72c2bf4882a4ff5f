#include "render/stf/stf_file.h"

#include "ingest/support/atomic_file.h"
#include "ingest/support/error.h"
#include "render/scene/content_hash.h"

#include <array>
#include <bit>
#include <fstream>

namespace scree {

namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");
static_assert(sizeof(ShellExit) == 24 && sizeof(ShellEvent) == 24);

constexpr std::array<char, 8> magic{'S', 'C', 'R', 'E', 'E', 'S', 'T', 'F'};
constexpr uint32_t version = 4; // also of what the numbers mean: count up when any of that changes

struct FileHead {
    std::array<char, 8> magic{};
    uint32_t version = 0, shells = 0;
    uint64_t key = 0;
    uint64_t checksum = 0; // of the shells
};

/// Before each shell's exits, exit weights, events and event weights.
struct ShellHead {
    double radius = 0, event_sum = 0;
    uint64_t exits = 0, events = 0;
};

template <class Shell, class Each>
void for_each_part(Shell& shell, const Each& each)
{
    const auto part = [&](auto& v) { each(v.data(), v.size() * sizeof(v[0])); };
    part(shell.exits);
    part(shell.exit_weights);
    part(shell.events);
    part(shell.event_weights);
}

uint64_t checksum_of(const ShellHead& head, const StfShell& shell, uint64_t hash)
{
    hash = hash_bytes(&head, sizeof head, hash);
    for_each_part(shell, [&](const void* bytes, size_t size) { hash = hash_bytes(bytes, size, hash); });
    return hash;
}

ShellHead head_of(const StfShell& shell) { return {shell.radius, shell.event_sum, shell.exits.size(), shell.events.size()}; }

} // namespace

void write_stf(const std::filesystem::path& file, const Stf& stf, uint64_t key)
{
    FileHead head{magic, version, static_cast<uint32_t>(stf.shells.size()), key, version};
    for (const StfShell& shell : stf.shells) head.checksum = checksum_of(head_of(shell), shell, head.checksum);
    AtomicFile output(file);
    std::ofstream stream(output.temporary(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(&head), sizeof head);
    for (const StfShell& shell : stf.shells) {
        const ShellHead of_shell = head_of(shell);
        stream.write(reinterpret_cast<const char*>(&of_shell), sizeof of_shell);
        for_each_part(shell, [&](const void* bytes, size_t size) { stream.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size)); });
    }
    stream.close();
    if (!stream) throw InputError(file.string(), "a file that cannot be written", "room for shell transport functions");
    output.commit();
}

void read_stf(const std::filesystem::path& file, uint64_t key, Stf& stf)
{
    const auto refuse = [&](const std::string& found) {
        return InputError(file.string(), found, "shell transport functions written by this version of Scree", "remove it; it will be made again");
    };
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) throw refuse("no file that can be read");
    auto left = static_cast<uint64_t>(stream.tellg());
    stream.seekg(0);
    const auto read = [&](void* bytes, uint64_t size) {
        if (size > left || !stream.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size))) throw refuse("a file that ends early");
        left -= size;
    };
    FileHead head;
    read(&head, sizeof head);
    if (head.magic != magic) throw refuse("something else");
    if (head.version != version) throw refuse("another version");
    if (head.key != key) throw refuse("shells of another medium");
    std::vector<StfShell> shells;
    uint64_t checksum = version;
    for (uint32_t i = 0; i < head.shells; ++i) {
        ShellHead of_shell;
        read(&of_shell, sizeof of_shell);
        constexpr uint64_t most = uint64_t{1} << 20; // as the builder's
        if (of_shell.exits == 0 || of_shell.events == 0 || of_shell.exits > most || of_shell.events > most || of_shell.radius != Stf::radius(i)) throw refuse("a damaged file: a shell that cannot be");
        StfShell shell;
        shell.radius = of_shell.radius;
        shell.event_sum = of_shell.event_sum;
        shell.exits.resize(of_shell.exits);
        shell.exit_weights.resize(of_shell.exits);
        shell.events.resize(of_shell.events);
        shell.event_weights.resize(of_shell.events);
        for_each_part(shell, read);
        checksum = checksum_of(of_shell, shell, checksum);
        shells.push_back(std::move(shell));
    }
    if (left != 0) throw refuse("a file of the wrong length");
    if (checksum != head.checksum) throw refuse("a damaged file: its checksum is wrong");
    stf.shells = std::move(shells);
}

} // namespace scree
