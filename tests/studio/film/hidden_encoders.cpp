// Stands before libavcodec (LD_PRELOAD) and hides the encoders that HIDDEN_ENCODERS names, as if the library had been
// built without them.

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <dlfcn.h>

#include <cstdlib>
#include <cstring>

namespace {

const AVCodec* unless_hidden(const AVCodec* codec) {
  const char* const hidden = std::getenv("HIDDEN_ENCODERS");
  return codec != nullptr && hidden != nullptr && std::strstr(hidden, codec->name) != nullptr ? nullptr : codec;
}

template <class Function>
Function own(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" const AVCodec* avcodec_find_encoder(AVCodecID id) {
  return unless_hidden(own<const AVCodec* (*)(AVCodecID)>("avcodec_find_encoder")(id));
}

extern "C" const AVCodec* avcodec_find_encoder_by_name(const char* name) {
  return unless_hidden(own<const AVCodec* (*)(const char*)>("avcodec_find_encoder_by_name")(name));
}
