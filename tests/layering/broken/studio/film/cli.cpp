#include <CLI/CLI.hpp>
#include <cstdio>

namespace ctpm::film {

const char* where = "give --camera";
const char* output = "-o";
const char* no_flag = "well-known, e - o";
void say() { std::printf("hello"); }

}  // namespace ctpm::film
