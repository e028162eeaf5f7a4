# Writes OUTPUT, which defines FUNCTION (declared in HEADER) from the files in FILES (separated by commas).
# -DFILES=<file>,<file> -DHEADER=<header> -DFUNCTION=<name> -DOUTPUT=<file>
set(entries "")
string(REPLACE "," ";" files ${FILES})
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND entries "      {\"${name}\", R\"file(${text})file\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace surefield {

const BuiltInFiles& ${FUNCTION}() {
  static const BuiltInFiles files = {
${entries}  };
  return files;
}

}  // namespace surefield
")
