# Writes a source with the files of page/ as text:
# cmake -DOUT=x.cc -P embed_pages.cmake
file(GLOB files ${CMAKE_CURRENT_LIST_DIR}/page/*)
set(rows "")
set(count 0)
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND rows "    {\"${name}\", R\"page~(${text})page~\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUT} "#include <string_view>

namespace finray {

extern const std::string_view kPageFiles[][2];
extern const int kPageFileCount;
const std::string_view kPageFiles[][2] = {
${rows}};
const int kPageFileCount = ${count};

}  // namespace finray
")
