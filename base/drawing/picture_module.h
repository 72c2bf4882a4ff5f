#pragma once

#include "base/drawing/picture_file.h"

#include <string>

// The functions of scree_pictures.so, the only part that uses OpenImageIO, for picture_file.cpp. A function that fails
// returns false and leaves OpenImageIO's message in `error`. Both sides are built together, so that they can exchange
// strings and vectors.
extern "C" {

/// Whether a picture with this path's extension can be encoded in memory.
bool scree_can_write_picture(const char* path);

/// Encodes the picture as the bytes of the file that write_picture_file writes.
bool scree_encode_picture(const char* path, int width, int height, const float* rgb, std::string& bytes,
                          std::string& error);

/// Reads a file; `picture.values` stays empty when the picture is cropped.
bool scree_read_picture(const char* path, scree::PictureFile& picture, std::string& error);
}
