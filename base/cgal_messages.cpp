#include "base/cgal_messages.h"

#include <CGAL/assertions.h>

namespace scree {

namespace {

void say_nothing(const char*, const char*, const char*, int, const char*) {}

} // namespace

void silence_cgal()
{
    static const bool once = [] {
        CGAL::set_error_handler(say_nothing);
        CGAL::set_warning_handler(say_nothing);
        return true;
    }();
    static_cast<void>(once);
}

} // namespace scree
