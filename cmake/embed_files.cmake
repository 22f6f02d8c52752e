# SPDX-License-Identifier: MIT
# cmake -DOUT=FILE.cpp -DROOT=FOLDER -DFILES=a;b -P embed_files.cmake: the texts of ROOT/a and ROOT/b, by these
# names, as the C++ source of lantern::gl::embedded_files().
set(text "// Made by cmake/embed_files.cmake.\n#include \"lantern/gl/shader_files.h\"\n\n")
string(APPEND text "namespace lantern::gl {\n\nconst FileTexts& embedded_files() {\n  static const FileTexts kFiles = {\n")
foreach(name IN LISTS FILES)
  file(READ "${ROOT}/${name}" content)
  string(APPEND text "      {\"${name}\", R\"~~~(${content})~~~\"},\n")
endforeach()
string(APPEND text "  };\n  return kFiles;\n}\n\n}  // namespace lantern::gl\n")
file(WRITE "${OUT}" "${text}")
