namespace ctpm {

struct Twice {
  double of_scenes = 0;
};

namespace {

struct Own {
  int x = 0;
};

}  // namespace
}  // namespace ctpm
