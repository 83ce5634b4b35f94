#include <itkMetaDataObject.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

#include "importers/label_map.h"
#include "importers/label_text.h"

namespace ctpm::importers {
namespace {

constexpr double kDeflate = 1032;         // largest ratio of deflate
constexpr double kMostVoxels = 4e8;       // a whole body at 1 mm has 2e8
constexpr std::size_t kMostKinds = 4096;  // a grey image has more values

/// The most bytes of voxels that the file can hold, or why it holds none itself.
Result<double> most_bytes(const std::string& path) {
  std::error_code trouble;
  const double size = double(std::filesystem::file_size(path, trouble));
  if (trouble) return Error{path, "cannot be read: " + trouble.message(), ""};
  std::ifstream file(path, std::ios::binary);
  if (suffix_of_map(path) != "nrrd") {
    const bool is_packed = file.get() == 0x1F && file.get() == 0x8B;
    return is_packed ? kDeflate * size : size;
  }
  double ratio = 1;
  constexpr int kMostLines = 10000;
  std::string line;
  for (int n = 0; n < kMostLines && std::getline(file, line) && !line.empty() && line != "\r"; ++n) {
    if (line.starts_with("data file:") || line.starts_with("datafile:"))
      return Error{path, "has its voxels in another file", "save it as one .nrrd file"};
    if (line.starts_with("encoding:") && line.find("gz") != std::string::npos) ratio = kDeflate;
  }
  return ratio * size;
}

/// Calls `work` with a pointer to numbers of the component type.
template <class Work>
bool with_type(itk::IOComponentEnum type, const char* bytes, const Work& work) {
  using C = itk::IOComponentEnum;
  switch (type) {
    case C::UCHAR:
      return work(reinterpret_cast<const unsigned char*>(bytes)), true;
    case C::CHAR:
      return work(reinterpret_cast<const signed char*>(bytes)), true;
    case C::USHORT:
      return work(reinterpret_cast<const unsigned short*>(bytes)), true;
    case C::SHORT:
      return work(reinterpret_cast<const short*>(bytes)), true;
    case C::UINT:
      return work(reinterpret_cast<const unsigned int*>(bytes)), true;
    case C::INT:
      return work(reinterpret_cast<const int*>(bytes)), true;
    case C::ULONG:
    case C::ULONGLONG:
      return work(reinterpret_cast<const unsigned long*>(bytes)), true;
    case C::LONG:
    case C::LONGLONG:
      return work(reinterpret_cast<const long*>(bytes)), true;
    case C::FLOAT:
      return work(reinterpret_cast<const float*>(bytes)), true;
    case C::DOUBLE:
      return work(reinterpret_cast<const double*>(bytes)), true;
    default:
      return false;
  }
}

/// The last line of ITK's message, which has the reason, without the function that says it.
std::string said_by(const itk::ExceptionObject& trouble) {
  std::string text = trouble.GetDescription();
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (const auto line = text.rfind('\n'); line != std::string::npos) text.erase(0, line + 1);
  if (const auto speaker = text.find(": "); speaker != std::string::npos) text.erase(0, speaker + 2);
  if (const auto object = text.find("): "); object != std::string::npos) text.erase(0, object + 3);
  return text.substr(0, 200);
}

/// Names of segments as 3D Slicer writes them, by layer and number.
std::map<std::pair<std::int32_t, std::int32_t>, std::string> segment_names(const itk::MetaDataDictionary& about) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::string> names;
  const auto field = [&](const std::string& key) {
    std::string text;
    itk::ExposeMetaData<std::string>(about, key, text);
    return text;
  };
  for (const std::string& key : about.GetKeys()) {
    constexpr std::string_view kEnd = "_LabelValue";
    if (!key.starts_with("Segment") || !key.ends_with(kEnd)) continue;
    const std::string segment = key.substr(0, key.size() - kEnd.size());
    const std::string layer = field(segment + "_Layer");
    names[{std::atoi(layer.c_str()), std::atoi(field(key).c_str())}] = field(segment + "_Name");
  }
  return names;
}

/// Size, place and axes of the voxels. Errors: not three-dimensional, flat, not finite.
Errors take_lattice(const itk::ImageIOBase& io, const std::string& path, LabelMap& map) {
  const unsigned dimensions = io.GetNumberOfDimensions();
  bool is_space = dimensions >= 3;
  for (unsigned d = 3; d < dimensions; ++d) is_space = is_space && io.GetDimensions(d) == 1;
  if (!is_space)
    return {{path, "is not a volume: it has " + std::to_string(dimensions) + " dimensions, a label map has three", ""}};
  double count = 1;
  for (unsigned d = 0; d < 3; ++d) count *= double(io.GetDimensions(d));
  if (!(count >= 1 && count <= kMostVoxels))
    return {{path, "says that it has " + number_text(count) + " voxels; 1 to " + number_text(kMostVoxels) + " are read",
             "crop it, or resample it"}};
  for (unsigned d = 0; d < 3; ++d) {
    map.size[d] = std::int32_t(io.GetDimensions(d));
    const std::vector<double> axis = io.GetDirection(d);
    const auto at = [&](std::size_t i) { return i < axis.size() ? axis[i] : 0.0; };
    map.step[d] = io.GetSpacing(d) * Vec3{at(0), at(1), at(2)};
  }
  map.origin = {io.GetOrigin(0), io.GetOrigin(1), io.GetOrigin(2)};
  const double volume = std::abs(dot(map.step[0], cross(map.step[1], map.step[2])));
  const double product = norm(map.step[0]) * norm(map.step[1]) * norm(map.step[2]);
  if (!is_finite(map.origin) || !std::isfinite(volume) || !(volume > 1e-6 * product) || !(product > 1e-12))
    return {{path, "has voxels without volume: its axes lie in a plane or have no length", "mend its header"}};
  return {};
}

/// Counts the labels, and turns the numbers into whole ones.
template <class T>
Errors take_values(const T* from, const std::string& path, const itk::MetaDataDictionary& about, LabelMap& map) {
  const auto layers = std::size_t(map.layers);
  const double volume = 1e-9 * std::abs(dot(map.step[0], cross(map.step[1], map.step[2])));
  std::map<std::pair<std::int32_t, std::int32_t>, std::int64_t> voxels;
  map.value.resize(map.voxel_count() * layers);
  std::pair<std::int32_t, std::int32_t> last{};
  std::int64_t* count = &voxels[last];
  for (std::size_t n = 0; n < map.value.size(); ++n) {
    const double value = double(from[n]);
    if (!(value == std::floor(value) && std::abs(value) < 2147483648.0))
      return {{path, "is not a label map: a voxel holds " + number_text(value) + ", which is not a whole number",
               "it may be the image itself; give its segmentation"}};
    map.value[n] = std::int32_t(value);
    const std::pair<std::int32_t, std::int32_t> kind{std::int32_t(n % layers), map.value[n]};
    if (kind != last) {
      if (voxels.size() > kMostKinds)
        return {{path, "is not a label map: it holds more than " + std::to_string(kMostKinds) + " different values",
                 "it may be the image itself; give its segmentation"}};
      last = kind, count = &voxels[kind];
    }
    ++*count;
  }
  auto names = segment_names(about);
  for (const auto& [kind, number] : voxels)
    if (kind.second != 0 && number > 0)
      map.labels.push_back({kind.second, names[kind], kind.first, number, volume * double(number)});
  if (map.labels.empty()) return {{path, "holds no label: every voxel is 0", ""}};
  return {};
}

Result<LabelMap> read_with(itk::ImageIOBase& io, const std::string& path) {
  const Result<double> most = most_bytes(path);
  if (!most) return most.errors();
  io.SetFileName(path);
  io.ReadImageInformation();
  LabelMap map;
  if (Errors errors = take_lattice(io, path, map); !errors.empty()) return errors;
  map.layers = std::int32_t(io.GetNumberOfComponents());
  const double needed = double(map.voxel_count()) * double(map.layers) * double(io.GetComponentSize());
  if (map.layers < 1 || needed > *most)
    return Error{path, "is cut short: its header promises " + number_text(needed) + " bytes of voxels",
                 "it may not have been copied whole"};
  std::vector<char> bytes(static_cast<std::size_t>(needed));
  itk::ImageIORegion all(io.GetNumberOfDimensions());
  for (unsigned d = 0; d < io.GetNumberOfDimensions(); ++d) all.SetSize(d, io.GetDimensions(d));
  io.SetIORegion(all);
  io.Read(bytes.data());
  Errors errors;
  if (!with_type(io.GetComponentType(), bytes.data(),
                 [&](const auto* from) { errors = take_values(from, path, io.GetMetaDataDictionary(), map); }))
    return Error{path, "holds numbers of an unknown kind", ""};
  if (!errors.empty()) return errors;
  return map;
}

}  // namespace

bool reads_label_maps() { return true; }

Result<LabelMap> read_label_map(const std::string& path) try {
  itk::Object::GlobalWarningDisplayOff();
  if (suffix_of_map(path) == "nrrd") return read_with(*itk::NrrdImageIO::New(), path);
  return read_with(*itk::NiftiImageIO::New(), path);
} catch (const itk::ExceptionObject& trouble) {
  return Error{path, "is not a label map that can be read: " + said_by(trouble), "NIfTI and NRRD files are read"};
}

}  // namespace ctpm::importers
