#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "core/model/vec3.h"
#include "studio/render/camera.h"
#include "studio/render/gl_context.h"

namespace ctpm::render {

/// A linked shader program.
class Program {
 public:
  Program() = default;
  /// Errors: the message of the compiler or linker, which is a bug of ours unless the driver is too old.
  static Result<Program> create(const Gl& gl, const std::string& name, const std::string& vertex,
                                const std::string& fragment);

  void use() const { gl_->UseProgram(id_); }
  GLuint id() const { return id_; }
  void set(const char* name, int value) const { gl_->Uniform1i(place(name), value); }
  void set(const char* name, double value) const { gl_->Uniform1f(place(name), float(value)); }
  void set(const char* name, Vec3 v) const { gl_->Uniform3f(place(name), float(v.x), float(v.y), float(v.z)); }
  void set(const char* name, Vec3 v, double w) const {
    gl_->Uniform4f(place(name), float(v.x), float(v.y), float(v.z), float(w));
  }
  void set(const char* name, const Mat4& matrix) const;

 private:
  GLint place(const char* name) const { return gl_->GetUniformLocation(id_, name); }
  const Gl* gl_ = nullptr;
  GLuint id_ = 0;
};

/// Vertices in buffers of the context. `stream` attributes change with every frame, indices seldom.
struct VertexArray {
  GLuint id = 0, stream = 0, indices = 0;
  std::size_t stream_bytes = 0;
  GLsizei index_count = 0;

  void create(const Gl& gl);
  /// Attribute `slot` reads `floats` floats at `offset` floats in each record of `stride` floats.
  void attribute(const Gl& gl, GLuint slot, int floats, int offset, int stride, GLuint divisor = 0) const;
  void set_indices(const Gl& gl, std::span<const std::uint32_t> index);
  void set_stream(const Gl& gl, std::span<const float> data);
};

/// A rectangle of a picture [pixels].
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The framebuffer that a picture is drawn to.
struct PictureTarget {
  GLuint framebuffer = 0, depth = 0;
  int width = 0, height = 0;
  bool has_stencil = false;

  /// Errors: the driver refuses the size.
  Result<Done> create(const Gl& gl, int width, int height);
  /// Gives it a stencil from now on. Each picture with one takes longer.
  void need_stencil(const Gl& gl);
  /// Clears the picture to transparent, and clips later drawing to the rectangle. Row 0 is the bottom.
  void begin(const Gl& gl, const PixelRect& rect) const;
  /// Reads the rectangle: RGBA, bottom row first.
  void read(const Gl& gl, const PixelRect& rect, std::vector<std::uint8_t>& rgba) const;
};

}  // namespace ctpm::render
