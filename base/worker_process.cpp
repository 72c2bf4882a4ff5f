#include "base/worker_process.h"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace scree {

namespace {

using Clock = std::chrono::steady_clock;

/// Closes a file descriptor at the end of its scope.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }
    void close()
    {
        if (number_ >= 0) ::close(number_);
        number_ = -1;
    }

private:
    int number_;
};

/// Starts the program with the socket as its standard input and output; returns its process id or the negated errno.
pid_t start(const std::filesystem::path& program, const std::vector<std::string>& arguments, int socket)
{
    std::vector<std::string> words{program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, socket, 0);
    posix_spawn_file_actions_adddup2(&actions, socket, 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", 1 /* O_WRONLY */, 0);
    pid_t process = 0;
    const int error = posix_spawn(&process, program.c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return error == 0 ? process : -error;
}

/// Sends the input and collects the output until the other side closes; returns what went wrong, or "".
std::string converse(int socket, std::span<const char> input, Clock::time_point deadline, size_t most_output,
                     std::vector<char>& output)
{
    std::vector<char> buffer(1 << 16);
    bool sending = true;
    for (;;) {
        if (sending && input.empty()) {
            shutdown(socket, SHUT_WR);
            sending = false;
        }
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) return "it took too long";
        pollfd ready{socket, static_cast<short>(sending ? POLLIN | POLLOUT : POLLIN), 0};
        if (poll(&ready, 1, static_cast<int>(std::min<long>(left, 1000))) < 0 && errno != EINTR)
            return std::strerror(errno);
        if (sending && (ready.revents & POLLOUT) != 0) {
            // MSG_NOSIGNAL: if the reader is gone, SIGPIPE would end this program.
            const ssize_t sent = send(socket, input.data(), input.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent > 0)
                input = input.subspan(static_cast<size_t>(sent));
            else if (errno != EAGAIN && errno != EINTR)
                sending = false; // the program closed its input early; its output still counts
        }
        if ((ready.revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
        const ssize_t got = recv(socket, buffer.data(), buffer.size(), MSG_DONTWAIT);
        if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return "";
        if (got < 0) continue;
        if (output.size() + static_cast<size_t>(got) > most_output) return "it wrote too much";
        output.insert(output.end(), buffer.begin(), buffer.begin() + got);
    }
}

/// Waits for the process until the deadline, then kills it; returns its wait status.
int wait_for(pid_t process, Clock::time_point deadline, bool& killed)
{
    int status = 0;
    for (;;) {
        const pid_t ended = waitpid(process, &status, killed ? 0 : WNOHANG);
        if (ended == process) return status;
        if (ended < 0 && errno != EINTR) return 0; // someone else waited for it
        if (Clock::now() >= deadline) {
            kill(process, SIGKILL);
            killed = true;
        } else {
            poll(nullptr, 0, 1);
        }
    }
}

} // namespace

WorkerResult run_worker(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                        std::span<const char> input, std::chrono::milliseconds timeout, size_t most_output)
{
    WorkerResult result;
    const Clock::time_point deadline = Clock::now() + timeout;
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        result.trouble = std::strerror(errno);
        return result;
    }
    Descriptor ours(ends[0]), theirs(ends[1]);
    const pid_t process = start(program, arguments, theirs.number());
    if (process < 0) {
        result.trouble = fmt::format("it could not be started: {}", std::strerror(-process));
        return result;
    }
    theirs.close();
    std::string trouble = converse(ours.number(), input, deadline, most_output, result.output);
    ours.close();
    bool killed = false;
    const int status = wait_for(process, trouble.empty() ? deadline : Clock::now(), killed);
    if (!trouble.empty())
        result.trouble = trouble;
    else if (killed)
        result.trouble = "it took too long";
    else if (WIFSIGNALED(status))
        result.trouble = fmt::format("it was stopped by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    else
        result.status = WEXITSTATUS(status);
    result.finished = result.status == 0;
    return result;
}

} // namespace scree
