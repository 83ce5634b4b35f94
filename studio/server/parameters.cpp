#include "studio/server/parameters.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "studio/output/number_text.h"

namespace ctpm::server {

struct Parameters::Content {
  nlohmann::json json;
  std::set<std::string> asked;
  Errors errors;
  std::vector<std::pair<std::string, std::shared_ptr<Content>>> inner;  ///< objects inside, with their places

  const nlohmann::json* find(const char* key) {
    asked.insert(key);
    const auto it = json.find(key);
    return it == json.end() || it->is_null() ? nullptr : &*it;
  }
  const nlohmann::json* need(const char* key) {
    const nlohmann::json* found = find(key);
    if (!found) errors.push_back({std::string("/") + key, "is missing", ""});
    return found;
  }
  void refuse(const char* key, const std::string& why) { errors.push_back({std::string("/") + key, why, ""}); }

  std::string take_text(const char* key, const nlohmann::json& value) {
    if (value.is_string()) return value.get<std::string>();
    return refuse(key, "must be a text"), "";
  }
  double take_number(const char* key, const nlohmann::json& value, double least, double most) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (number >= least && number <= most) return number;
    refuse(key, "must be a number in [" + output::short_number(least, 9) + ", " + output::short_number(most, 9) + "]");
    return least;
  }
};

Parameters::Parameters(std::shared_ptr<Content> content) : content_(std::move(content)) {}

Result<Parameters> Parameters::parse(std::string_view text) {
  auto content = std::make_shared<Content>();
  content->json = nlohmann::json::parse(text, nullptr, false);
  if (content->json.is_discarded()) return Error{"message", "is not JSON", ""};
  if (!content->json.is_object()) return Error{"message", "must be a JSON object", ""};
  return Parameters(std::move(content));
}

std::string Parameters::text(const char* key) {
  const nlohmann::json* value = content_->need(key);
  return value ? content_->take_text(key, *value) : "";
}

std::optional<std::string> Parameters::text_if(const char* key) {
  const nlohmann::json* value = content_->find(key);
  if (!value) return std::nullopt;
  return content_->take_text(key, *value);
}

double Parameters::number(const char* key, double least, double most) {
  const nlohmann::json* value = content_->need(key);
  return value ? content_->take_number(key, *value, least, most) : least;
}

std::optional<double> Parameters::number_if(const char* key, double least, double most) {
  const nlohmann::json* value = content_->find(key);
  if (!value) return std::nullopt;
  return content_->take_number(key, *value, least, most);
}

bool Parameters::flag(const char* key, bool otherwise) {
  const nlohmann::json* value = content_->find(key);
  if (!value) return otherwise;
  if (value->is_boolean()) return value->get<bool>();
  return refuse(key, "must be true or false"), otherwise;
}

std::vector<double> Parameters::numbers(const char* key, std::size_t count) {
  std::vector<double> list(count, 0.0);
  const nlohmann::json* value = content_->need(key);
  if (!value) return list;
  bool is_good = value->is_array() && value->size() == count;
  for (std::size_t i = 0; is_good && i < count; ++i) {
    const nlohmann::json& number = (*value)[i];
    is_good = number.is_number() && std::isfinite(number.get<double>());
    if (is_good) list[i] = number.get<double>();
  }
  if (!is_good) refuse(key, "must be a list of " + std::to_string(count) + " finite numbers");
  return list;
}

std::vector<double> Parameters::numbers_if(const char* key, std::size_t count) {
  return content_->find(key) ? numbers(key, count) : std::vector<double>();
}

std::vector<std::string> Parameters::texts_if(const char* key) {
  std::vector<std::string> list;
  const nlohmann::json* value = content_->find(key);
  if (!value) return list;
  if (!value->is_array()) return refuse(key, "must be a list"), list;
  for (const nlohmann::json& text : *value) list.push_back(content_->take_text(key, text));
  return list;
}

std::optional<Parameters> Parameters::object_if(const char* key) {
  const nlohmann::json* value = content_->find(key);
  if (!value) return std::nullopt;
  auto inner = std::make_shared<Content>();
  if (value->is_object())
    inner->json = *value;
  else
    refuse(key, "must be an object"), inner->json = nlohmann::json::object();
  content_->inner.emplace_back(std::string("/") + key, inner);
  return Parameters(inner);
}

std::vector<Parameters> Parameters::objects(const char* key) {
  std::vector<Parameters> list;
  const nlohmann::json* value = content_->need(key);
  if (!value) return list;
  if (!value->is_array()) return refuse(key, "must be a list"), list;
  for (std::size_t i = 0; i < value->size(); ++i) {
    auto inner = std::make_shared<Content>();
    inner->json = (*value)[i].is_object() ? (*value)[i] : nlohmann::json::object();
    if (!(*value)[i].is_object()) refuse(key, "must be a list of objects");
    content_->inner.emplace_back(std::string("/") + key + "/" + std::to_string(i), inner);
    list.push_back(Parameters(inner));
  }
  return list;
}

Errors Parameters::errors() const {
  Errors errors = content_->errors;
  for (const auto& [key, value] : content_->json.items())
    if (!content_->asked.contains(key)) errors.push_back({"/" + key, "is not known here", ""});
  for (const auto& [place, inner] : content_->inner)
    for (Error error : Parameters(inner).errors()) {
      error.where = place + error.where;
      errors.push_back(std::move(error));
    }
  return errors;
}

void Parameters::refuse(const char* key, const std::string& why) { content_->refuse(key, why); }

}  // namespace ctpm::server
