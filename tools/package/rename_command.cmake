# In what is about to be packed `identify` becomes `tribofit`; postinst gives it the other name where that is free.
file(GLOB_RECURSE commands ${CPACK_TEMPORARY_DIRECTORY}/*/bin/identify)
foreach(command IN LISTS commands)
  get_filename_component(folder ${command} DIRECTORY)
  file(RENAME ${command} ${folder}/tribofit)
endforeach()
