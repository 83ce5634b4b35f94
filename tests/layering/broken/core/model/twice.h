namespace ctpm {

struct Twice {
  int of_core = 0;
};

}  // namespace ctpm
