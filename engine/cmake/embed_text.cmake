# Writes OUTPUT, which defines FUNCTION (declared in HEADER) to return the text of FILE.
# -DFILE=<file> -DHEADER=<header> -DFUNCTION=<name> -DOUTPUT=<file>
file(READ ${FILE} text)
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace surefield {

const std::string& ${FUNCTION}() {
  static const std::string text = R\"text(${text})text\";
  return text;
}

}  // namespace surefield
")
