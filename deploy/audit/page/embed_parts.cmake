# SPDX-License-Identifier: Apache-2.0
# Writes the source file OUTPUT with the contents of report.css and report.js in DIRECTORY.
file(READ ${DIRECTORY}/report.css style)
file(READ ${DIRECTORY}/report.js script)
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"deploy/audit/page/page_parts.hpp\"

namespace sidestep {

const char* const kPageStyle = R\"part(${style})part\";
const char* const kPageScript = R\"part(${script})part\";

}  // namespace sidestep
")
