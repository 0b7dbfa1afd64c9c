# Makes page.cpp, which holds the page and openapi.json: cmake -DSTEP=install|build|none … -P page.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${COPY}/workbench RESULT_VARIABLE failed OUTPUT_VARIABLE said
    ERROR_VARIABLE said)
  if(failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command} failed:\n${said}\n"
      "Without the page: cmake -DMANSARD_PAGE=OFF. Behind a proxy or without a network, see docs/serve.md.")
  endif()
endfunction()

if(STEP STREQUAL install)
  file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${COPY}/workbench)
  run(${NPM} ci --ignore-scripts --no-audit --no-fund)
  file(TOUCH ${COPY}/installed)
  return()
endif()

file(REMOVE_RECURSE ${COPY}/made)
if(STEP STREQUAL build)
  file(REMOVE_RECURSE ${COPY}/workbench/src ${COPY}/workbench/public)
  file(COPY ${SOURCE}/src ${SOURCE}/public ${SOURCE}/index.html ${SOURCE}/tsconfig.json ${SOURCE}/vite.config.ts
    DESTINATION ${COPY}/workbench
    PATTERN "*.test.ts" EXCLUDE PATTERN "*.test.tsx" EXCLUDE PATTERN "schema.d.ts" EXCLUDE)
  file(COPY ${API} DESTINATION ${COPY}/server)
  set(ENV{MANSARD_PAGE} ${COPY}/made)
  run(${NPM} run build)
else()
  file(WRITE ${COPY}/made/index.html "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>mansard</title></head>\n"
    "<body><p>This mansard was built without the page of the workbench: node and npm were missing, or "
    "MANSARD_PAGE was off. What it serves under /api works. See docs/serve.md.</p></body></html>\n")
endif()

set(mime_html "text/html; charset=utf-8")
set(mime_js "text/javascript; charset=utf-8")
set(mime_css "text/css; charset=utf-8")
set(mime_json "application/json")
set(mime_svg "image/svg+xml")
set(mime_png "image/png")
set(mime_wasm "application/wasm")
set(mime_txt "text/plain; charset=utf-8")

file(COPY_FILE ${API} ${COPY}/openapi.json)
file(GLOB_RECURSE names RELATIVE ${COPY}/made ${COPY}/made/*)
list(SORT names)
set(assembly "")
set(externs "")
set(table "")
macro(embed symbol path)
  string(APPEND assembly "    \".global ${symbol}\\n${symbol}:\\n.incbin \\\"${path}\\\"\\n.global ${symbol}_end\\n${symbol}_end:\\n.byte 0\\n\"\n")
  string(APPEND externs "extern const char ${symbol}[], ${symbol}_end[];\n")
endmacro()
embed(mansard_openapi ${COPY}/openapi.json)
set(count 0)
foreach(name IN LISTS names)
  cmake_path(GET name EXTENSION LAST_ONLY extension)
  string(SUBSTRING "${extension}" 1 -1 extension)
  if(NOT DEFINED mime_${extension})
    message(FATAL_ERROR "apps/server/page.cmake knows no MIME type for ${name}; add it")
  endif()
  file(SHA256 ${COPY}/made/${name} hash)
  string(SUBSTRING ${hash} 0 16 hash)
  embed(mansard_page_${count} ${COPY}/made/${name})
  string(APPEND table "      {\"${name}\", between(mansard_page_${count}, mansard_page_${count}_end), \"${mime_${extension}}\", \"${hash}\"},\n")
  math(EXPR count "${count} + 1")
endforeach()

file(WRITE ${OUT} "// Made by apps/server/page.cmake.
#include <array>

#include \"apps/server/assets.hpp\"

asm(\".pushsection .rodata\\n\"
${assembly}    \".popsection\\n\");

extern \"C\" {
${externs}}

namespace mansard::server {
namespace {
auto between(const char* from, const char* to) -> std::string_view {
  return {from, static_cast<std::size_t>(to - from)};
}
}  // namespace

auto assets() -> std::span<const Asset> {
  static const std::array<Asset, ${count}> all{{
${table}  }};
  return all;
}

auto openapi() -> std::string_view { return between(mansard_openapi, mansard_openapi_end); }

}  // namespace mansard::server
")
