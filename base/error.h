#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace scree {

/// An error in the user's input, described so that the user can correct it.
///
/// Every library of Scree throws it for unusable input; the program prints it and exits with status 2.
class InputError : public std::runtime_error {
public:
    /// place: file, "file:line" or "file: /json/path"; found: what is there; expected: what should be there;
    /// hint: what to try (may be empty).
    InputError(std::string place, std::string found, std::string expected, std::string hint = "");

    const std::string& place() const { return place_; }
    const std::string& found() const { return found_; }
    const std::string& expected() const { return expected_; }
    const std::string& hint() const { return hint_; }

private:
    std::string place_, found_, expected_, hint_;
};

/// Thrown by long work when its Progress was cancelled and there is no partial result to keep.
class Cancelled : public std::runtime_error {
public:
    Cancelled() : std::runtime_error("cancelled") {}
};

/// ", did you mean 'x'?" naming the entry of candidates nearest to word by edit distance, or "" when none is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

} // namespace scree
