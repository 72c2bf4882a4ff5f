#pragma once

#include "base/drawing/picture_file.h"

#include <string>

// What scree_pictures.so, the one part that knows OpenImageIO, gives to picture_file.cpp; what fails returns false and
// leaves the library's words in `error`. Both are built as one: strings and vectors may pass.
extern "C" {

/// Whether a picture of this path's extension can be made in memory.
bool scree_can_write_picture(const char* path);

/// Makes the file that holds the picture, as write_picture_file writes it.
bool scree_encode_picture(const char* path, int width, int height, const float* rgb, std::string& bytes,
                          std::string& error);

/// Reads a file; no values when it is not whole.
bool scree_read_picture(const char* path, scree::PictureFile& picture, std::string& error);
}
