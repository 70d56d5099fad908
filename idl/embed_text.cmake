# SPDX-License-Identifier: Apache-2.0
# Writes the source file OUTPUT with the text of all definitions. INPUT: a file that includes all IDL files of DIRECTORY;
# COMPILER: its preprocessor resolves the includes and removes the comments.
execute_process(COMMAND ${COMPILER} -E -P -x c -I ${DIRECTORY} ${INPUT} OUTPUT_VARIABLE text RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${INPUT}: cannot be preprocessed")
endif()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"common/messaging/message_schema.hpp\"

namespace sidestep {

const char* const kIdlText = R\"idl(${text})idl\";

}  // namespace sidestep
")
