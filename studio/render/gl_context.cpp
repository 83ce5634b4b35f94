#include "studio/render/gl_context.h"

#include <GL/osmesa.h>

namespace ctpm::render {

Result<std::unique_ptr<GlContext>> GlContext::create() {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  std::unique_ptr<GlContext> context(new GlContext);
  context->context_ = OSMesaCreateContextAttribs(attributes, nullptr);
  const Error missing{"OpenGL", "OSMesa gives no OpenGL 3.3 core context", "install libosmesa6 22 or newer"};
  if (!context->context_) return missing;
  if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context->context_), context->pixels_, GL_UNSIGNED_BYTE, 16, 16))
    return missing;
  Errors errors;
#define CTPM_GL_FETCH(type, name)                                               \
  context->gl_.name = reinterpret_cast<type>(OSMesaGetProcAddress("gl" #name)); \
  if (!context->gl_.name) errors.push_back({"OpenGL", "OSMesa has no gl" #name, missing.hint});
  CTPM_GL_ENTRY_POINTS(CTPM_GL_FETCH)
#undef CTPM_GL_FETCH
  if (!errors.empty()) return errors;
  return context;
}

GlContext::~GlContext() {
  if (context_) OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

void GlContext::make_current() {
  if (OSMesaGetCurrentContext() == context_) return;
  CTPM_CHECK(OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), pixels_, GL_UNSIGNED_BYTE, 16, 16),
             "an OSMesa context cannot be made current");
}

}  // namespace ctpm::render
