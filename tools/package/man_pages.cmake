# A man page for the command and for each of its verbs, compressed as Debian has them.
# cmake -D IDENTIFY=... -D HELP2MAN=... -D VERSION=... -D FOLDER=... -P man_pages.cmake
execute_process(COMMAND ${IDENTIFY} completion verbs OUTPUT_VARIABLE verbs COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "\n$" "" verbs "${verbs}")
string(REPLACE "\n" ";" verbs "${verbs}")  # the first is empty: the command itself
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
foreach(verb IN LISTS verbs)
  string(REPLACE " " ";" words "${verb}")
  execute_process(COMMAND ${IDENTIFY} ${words} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "^[^\n:]+" summary "${help}")
  string(REPLACE " " "-" page "tribofit ${verb}")
  string(REGEX REPLACE "-$" "" page "${page}")
  # It runs what it is given in a shell: a verb is a part of it.
  execute_process(
    COMMAND ${HELP2MAN} --no-info --version-string=${VERSION} "--name=${summary}" "${IDENTIFY} ${verb}"
    OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(TOUPPER ${page} title)
  string(REGEX REPLACE "\n\\.TH [^\n]*" "\n.TH ${title} 1 \"\" \"tribofit ${VERSION}\"" text "${text}")
  string(REGEX REPLACE "\n\\.SH NAME\n[^\n]*\n" "\n.SH NAME\n${page} \\\\- ${summary}\n" text "${text}")
  # Each example on a line of its own.
  string(REGEX REPLACE "\n\\.IP\n((identify[^\n]*\n)+)" "\n.IP\n.nf\n\\1.fi\n" text "${text}")
  file(WRITE ${FOLDER}/${page}.1 "${text}")
  execute_process(COMMAND gzip -9nk ${FOLDER}/${page}.1 COMMAND_ERROR_IS_FATAL ANY)
endforeach()
