# SPDX-License-Identifier: Apache-2.0
# Makes the generated plain types as cheap as structs: their accessors are defined in the header, where they can be
# inlined, and their constructors and assignments are defaulted, so that a copy is a plain move of memory. Setters of
# sequences stay where they are, because each file that includes the header would instantiate std::vector's assignments.
#   cmake -D DIRECTORY=... -D NAMES=... -P inline_types.cmake
# If a pattern does not match the generator's output, the result does not compile or does not link.
function(replace pattern by)
  string(REGEX REPLACE "${pattern}" "${by}" text "${text}")
  set(text "${text}" PARENT_SCOPE)
endfunction()

foreach(name IN LISTS NAMES)
  file(READ ${DIRECTORY}/${name}.h text)
  set(export "eProsima_user_DllExport +")
  replace("${export}~[A-Za-z]+\\(\\);" "")
  replace("${export}([A-Za-z]+)\\(\\);" "\\1() = default;")
  replace("${export}([A-Za-z]+& operator =|[A-Za-z]+)(\\([ \n]*const [A-Za-z]+& x\\));" "\\1\\2 = default;")
  replace("${export}([A-Za-z]+& operator =|[A-Za-z]+)(\\([ \n]*[A-Za-z]+&& x\\) noexcept);" "\\1\\2 = default;")
  replace("${export}([^;()]*)([ &])([a-z0-9_]+)\\(\\) const;" "\\1\\2\\3() const { return m_\\3; }")
  replace("${export}([^;()]*& )([a-z0-9_]+)\\(\\);" "\\1\\2() { return m_\\2; }")
  replace("${export}(void [a-z0-9_]+\\([^();]*std::vector)" "\\1")
  replace("${export}void ([a-z0-9_]+)\\([ \n]*([^();]*&& )_[a-z0-9_]+\\);" "void \\1(\\2value) { m_\\1 = std::move(value); }")
  replace("${export}void ([a-z0-9_]+)\\([ \n]*([^();]* |[^();]*& ?)_[a-z0-9_]+\\);" "void \\1(\\2value) { m_\\1 = value; }")
  replace("\n( +[A-Za-z][A-Za-z0-9_:<>, ]* m_[a-z0-9_]+);" "\n\\1{};")
  file(WRITE ${DIRECTORY}/${name}.h "${text}")
  file(WRITE ${DIRECTORY}/${name}.hpp "#include \"${name}.h\"\n")

  file(READ ${DIRECTORY}/${name}.cxx text)
  set(type "sidestep::msg::[A-Za-z]+")
  replace("\n${type}::~?[A-Za-z]+\\([^)]*\\)( noexcept)? *\n{[^}]*}\n" "\n")
  replace("\n${type}& ${type}::operator =\\([^)]*\\)( noexcept)? *\n{[^}]*}\n" "\n")
  replace("\nvoid (${type}::[a-z0-9_]+\\([^)]*std::vector)" "\nvoid\t\\1")  # not matched by the pattern below
  replace("\n[^\n]* ${type}::[a-z0-9_]+\\([^)]*\\)( const)? *\n{\n *(return )?m_[^}]*}\n" "\n")
  file(WRITE ${DIRECTORY}/${name}.cxx "${text}")
endforeach()
