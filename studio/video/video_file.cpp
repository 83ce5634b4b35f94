#include "studio/video/video_file.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <cstdint>
#include <utility>

namespace ctpm::video {
namespace {

/// A preset of x264 that takes a third of the time of its usual one (`medium`, 23), and the quality at which pictures
/// are as good (SSIM), in files that are a quarter to a third larger. Slow gradients of a background show blocks first
/// in their hue, which is therefore coded a little finer.
constexpr const char *kPreset = "veryfast", *kQuality = "20", *kFinerHue = "-2";

/// Quantiser of Motion JPEG: 2 of 2 to 31, nearly lossless.
constexpr int kJpegQuantiser = 2;

struct Deleter {
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
  void operator()(AVFormatContext* p) const {
    avio_closep(&p->pb);
    avformat_free_context(p);
  }
};
struct Closer {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

AVCodecID id_of(Coding coding) { return coding == Coding::h264 ? AV_CODEC_ID_H264 : AV_CODEC_ID_MJPEG; }

const AVCodec* find_encoder(Coding coding) {
  const AVCodec* const best = coding == Coding::h264 ? avcodec_find_encoder_by_name("libx264") : nullptr;
  return best ? best : avcodec_find_encoder(id_of(coding));
}

}  // namespace

struct VideoFile::Parts {
  std::string path;
  Coding coding;
  Owned<AVFormatContext> file;
  Owned<AVCodecContext> encoder;
  Owned<AVFrame> picture;
  Owned<AVPacket> packet;
  Owned<SwsContext> to_yuv;

  bool open_encoder(int width, int height, double fps);
  bool open_file();
  Result<Done> encode(const AVFrame* frame);
  Error problem(int code) const;
};

Error VideoFile::Parts::problem(int code) const {
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(code, text, sizeof text);
  return {path, "a frame could not be written: " + std::string(text), "check the free space"};
}

bool VideoFile::Parts::open_encoder(int width, int height, double fps) {
  const AVCodec* const codec = find_encoder(coding);
  // What is written is opened again and counted, so there must be a reader, too.
  if (!codec || !avcodec_find_decoder(id_of(coding))) return false;
  encoder.reset(avcodec_alloc_context3(codec));
  AVCodecContext& c = *encoder;
  constexpr int kFinest = 100000;
  c.framerate = av_d2q(fps, kFinest), c.time_base = av_inv_q(c.framerate);
  c.width = width, c.height = height, c.pix_fmt = AV_PIX_FMT_YUV420P;
  const bool is_h264 = coding == Coding::h264;
  if (is_h264) {
    c.color_range = AVCOL_RANGE_MPEG, c.colorspace = AVCOL_SPC_BT709;
    c.color_primaries = AVCOL_PRI_BT709, c.color_trc = AVCOL_TRC_BT709;
    c.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    av_opt_set(c.priv_data, "preset", kPreset, 0), av_opt_set(c.priv_data, "crf", kQuality, 0);
    av_opt_set(c.priv_data, "chromaoffset", kFinerHue, 0);
  } else {
    c.color_range = AVCOL_RANGE_JPEG, c.colorspace = AVCOL_SPC_BT470BG;
    c.flags |= AV_CODEC_FLAG_QSCALE, c.global_quality = kJpegQuantiser * FF_QP2LAMBDA;
  }
  if (avcodec_open2(&c, codec, nullptr) < 0) return false;

  picture.reset(av_frame_alloc()), packet.reset(av_packet_alloc());
  picture->width = width, picture->height = height, picture->format = c.pix_fmt;
  picture->color_range = c.color_range, picture->quality = c.global_quality;
  if (av_frame_get_buffer(picture.get(), 0) < 0) return false;
  to_yuv.reset(
      sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, c.pix_fmt, SWS_AREA, nullptr, nullptr, nullptr));
  const int* const matrix = sws_getCoefficients(is_h264 ? SWS_CS_ITU709 : SWS_CS_ITU601);
  constexpr int kAsItIs = 1 << 16;  // contrast and saturation
  return to_yuv && sws_setColorspaceDetails(to_yuv.get(), matrix, 1, matrix, is_h264 ? 0 : 1, 0, kAsItIs, kAsItIs) >= 0;
}

bool VideoFile::Parts::open_file() {
  AVFormatContext* opened = nullptr;
  if (avformat_alloc_output_context2(&opened, nullptr, coding == Coding::h264 ? "mp4" : "avi", path.c_str()) < 0)
    return false;
  file.reset(opened);
  AVStream* const stream = avformat_new_stream(opened, nullptr);
  stream->time_base = encoder->time_base, stream->avg_frame_rate = encoder->framerate;
  return avcodec_parameters_from_context(stream->codecpar, encoder.get()) >= 0 &&
         avio_open(&opened->pb, path.c_str(), AVIO_FLAG_WRITE) >= 0 && avformat_write_header(opened, nullptr) >= 0;
}

/// Gives a frame to the encoder, or none at the end, and writes what comes out of it.
Result<Done> VideoFile::Parts::encode(const AVFrame* frame) {
  int code = avcodec_send_frame(encoder.get(), frame);
  while (code >= 0) {
    code = avcodec_receive_packet(encoder.get(), packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return Done{};
    if (code < 0) break;
    packet->duration = 1;
    av_packet_rescale_ts(packet.get(), encoder->time_base, file->streams[0]->time_base);
    code = av_interleaved_write_frame(file.get(), packet.get());
  }
  return problem(code);
}

VideoFile::VideoFile(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
VideoFile::~VideoFile() = default;

std::unique_ptr<VideoFile> VideoFile::create(const std::string& path, Coding coding, int width, int height,
                                             double fps) {
  av_log_set_level(AV_LOG_ERROR);
  auto parts = std::make_unique<Parts>();
  parts->path = path, parts->coding = coding;
  if (!parts->open_encoder(width, height, fps) || !parts->open_file()) return nullptr;
  return std::unique_ptr<VideoFile>(new VideoFile(std::move(parts)));
}

std::string VideoFile::library() {
  const unsigned version = avcodec_version();
  return "libavcodec " + std::to_string(AV_VERSION_MAJOR(version)) + "." + std::to_string(AV_VERSION_MINOR(version)) +
         "." + std::to_string(AV_VERSION_MICRO(version));
}

Result<Done> VideoFile::add(const render::Frame& frame) {
  Parts& p = *parts_;
  // The encoder may still look at the last frame's buffer.
  if (const int code = av_frame_make_writable(p.picture.get()); code < 0) return p.problem(code);
  const std::uint8_t* const from[] = {frame.rgb.data()};
  const int row[] = {3 * frame.width};
  sws_scale(p.to_yuv.get(), from, row, 0, frame.height, p.picture->data, p.picture->linesize);
  p.picture->pts = p.picture->pts == AV_NOPTS_VALUE ? 0 : p.picture->pts + 1;
  return p.encode(p.picture.get());
}

Result<Done> VideoFile::finish() {
  Parts& p = *parts_;
  if (Result<Done> done = p.encode(nullptr); !done) return done;
  if (const int code = av_write_trailer(p.file.get()); code < 0) return p.problem(code);
  if (const int code = avio_closep(&p.file->pb); code < 0) return p.problem(code);
  return Done{};
}

Result<InVideoFile> read_video_file(const std::string& path) {
  const std::string hint = "check the free space";
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, path.c_str(), nullptr, nullptr) < 0)
    return Error{path, "the video that was written cannot be opened again", hint};
  const std::unique_ptr<AVFormatContext, Closer> file(opened);
  const AVCodec* codec = nullptr;
  const int number = avformat_find_stream_info(opened, nullptr) < 0
                         ? -1
                         : av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
  if (number < 0 || !codec) return Error{path, "the video that was written cannot be opened again", hint};
  const AVStream& stream = *opened->streams[number];
  const Owned<AVCodecContext> decoder(avcodec_alloc_context3(codec));
  const Owned<AVFrame> picture(av_frame_alloc());
  const Owned<AVPacket> packet(av_packet_alloc());
  InVideoFile found{stream.codecpar->width, stream.codecpar->height, av_q2d(stream.avg_frame_rate), 0};
  bool is_open = avcodec_parameters_to_context(decoder.get(), stream.codecpar) >= 0 &&
                 avcodec_open2(decoder.get(), codec, nullptr) >= 0;
  bool is_decoded = false;
  // To decode all of them takes a good part of the time that it took to encode them.
  for (; av_read_frame(opened, packet.get()) >= 0; av_packet_unref(packet.get())) {
    if (packet->stream_index != number) continue;
    ++found.frames;
    if (is_decoded || !is_open) continue;
    is_open = avcodec_send_packet(decoder.get(), packet.get()) >= 0;
    is_decoded = is_open && avcodec_receive_frame(decoder.get(), picture.get()) >= 0;
  }
  // A decoder may hold frames back until it knows that no more come.
  if (!is_decoded && is_open && avcodec_send_packet(decoder.get(), nullptr) >= 0)
    is_decoded = avcodec_receive_frame(decoder.get(), picture.get()) >= 0;
  if (!is_decoded) return Error{path, "no frame of the video that was written can be decoded", hint};
  return found;
}

}  // namespace ctpm::video
