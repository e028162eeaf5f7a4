# Writes OUTPUT, which defines built_in_configs() from the files in FILES (separated by commas).
# -DFILES=<file>,<file> -DOUTPUT=<file>
set(entries "")
string(REPLACE "," ";" files ${FILES})
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND entries "      {\"${name}\", R\"yaml(${text})yaml\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"tools/build_info.h\"

namespace surefield {

const BuiltInFiles& built_in_configs() {
  static const BuiltInFiles files = {
${entries}  };
  return files;
}

}  // namespace surefield
")
