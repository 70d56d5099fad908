# SPDX-License-Identifier: Apache-2.0
# Writes the source file OUTPUT with the text of PAGE.
file(READ ${PAGE} text)
if(text MATCHES "\\)page\"")
  message(FATAL_ERROR "${PAGE}: contains the end of a raw string")
endif()
string(LENGTH "${text}" length)
if(length GREATER 60000)
  message(FATAL_ERROR "${PAGE}: ${length} bytes, more than a string literal may have")
endif()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"deploy/trial/scenario/key_descriptions.hpp\"

namespace sidestep {

const char* const kKeysPage = R\"page(${text})page\";

}  // namespace sidestep
")
