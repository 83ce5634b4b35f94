# Writes BUNDLE as a C++ array to OUTPUT.
file(READ ${BUNDLE} digits HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${digits}")
string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"studio/server/page_bytes.h\"\n\nnamespace ctpm::server {\n\nconst unsigned char kPageBundle[] = {\n${bytes}};\nconst std::size_t kPageBundleSize = sizeof kPageBundle;\n\n}  // namespace ctpm::server\n")
