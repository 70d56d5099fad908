# SPDX-License-Identifier: Apache-2.0
"""The tests of a tree, and the commands in its texts that select none of them. Used by tests/references.

It reads the titles from the sources and CMakeLists.txt, because a build may be old or missing. It does not know test
cases that a macro in a header makes.
"""
import dataclasses
import os
import re

STRING = r'"(?:[^"\\]|\\.)*"'
STRINGS = rf"((?:{STRING}\s*)+)"
TEST_CASE = re.compile(rf"\b(TEMPLATE_)?TEST_CASE\(\s*{STRINGS}(?:,\s*{STRINGS})?(?:,([^(){{}}]*))?\)")
CMAKE_COMMENT = re.compile(r"(?m)(?:^|(?<=\s))#.*")
CMAKE_COMMAND = re.compile(
    rf"\b(set|add_test|add_executable|sidestep_add_(?:program|tests|fuzzer))\(((?:{STRING}|[^()\"])*)\)")
CMAKE_WORD = re.compile(rf"{STRING}|[^\s\"]+")
SOURCES_END = ("TIMEOUT", "LINK", "COMMAND")
FUZZ_TESTS = "replay_test.cpp"  # has the test cases of each fuzzer

# A command in a text may be cut by the end of its backticks.
CTEST_PATTERN = re.compile(rf"(?:\b(?:tests/run|ctest)\b[^\n`]*?\s|`)-R\s+({STRING}|[^\s`]+)")
PROGRAM_RUN = re.compile(rf"build/\w+/bin/([\w-]+)(?:\s+({STRING}))?")
MUTANT_PROGRAMS = re.compile(r"(?m)^tests: (.*)$")
FILTER_PART = re.compile(r"(?:\\.|[^\\,])+")
FILTER_TERM = re.compile(r"(~?)(?:\[([^\]]*)\]|((?:\\.|[^\\\[~])+))")


@dataclasses.dataclass(frozen=True)
class TestCase:
    program: str
    name: str
    tags: frozenset

    @property
    def is_hidden(self):
        """Whether the program runs it only if a filter selects it; ctest does not know it."""
        return bool(self.tags & {".", "!hide"})


def joined(strings):
    """The value of string literals that follow each other."""
    return re.sub(r"\\(.)", r"\1", "".join(part[1:-1] for part in re.findall(STRING, strings or "")))


def tags_of(text):
    """The tags of a test case or filter, lower case; [.long] stands for [.][long]."""
    tags = {tag.lower() for tag in re.findall(r"\[([^\]]*)\]", text)}
    return frozenset({"."} & {tag[:1] for tag in tags} | {tag.lstrip(".") for tag in tags if tag != "."})


def test_cases(program, source):
    for template, name, tags, types in TEST_CASE.findall(source):
        suffixes = [" - " + word.strip() for word in types.split(",")] if template else [""]
        yield from (TestCase(program, joined(name) + suffix, tags_of(joined(tags))) for suffix in suffixes)


class Tests:
    """All tests of a tree, given as texts by their names."""

    def __init__(self, texts):
        self.programs = set()
        self.cases = []
        self.titles = []  # of the tests that ctest knows
        for name, text in texts.items():
            if os.path.basename(name) == "CMakeLists.txt":
                self._read_cmake(os.path.dirname(name), CMAKE_COMMENT.sub("", text), texts)
        self.titles += [f"{case.program}:{case.name}" for case in self.cases if not case.is_hidden]

    def _read_cmake(self, folder, text, texts):
        variables = {}
        for command, arguments in CMAKE_COMMAND.findall(text):
            words = [re.sub(r"\$\{(\w+)\}", lambda match: variables.get(match.group(1), match.group()), word.strip('"'))
                     for word in CMAKE_WORD.findall(arguments)]
            if command == "set" and len(words) == 2:
                variables[words[0]] = words[1]
            elif command == "add_test" and words[0] == "NAME":
                self.titles.append(words[1])
            elif command not in ("set", "add_test"):
                self._add_program(command, words, folder, texts)

    def _add_program(self, command, words, folder, texts):
        program = ("fuzz_" if command == "sidestep_add_fuzzer" else "") + words[0]
        self.programs.add(program)
        if command not in ("sidestep_add_tests", "sidestep_add_fuzzer") or "$" in program:
            return
        end = next((i for i, word in enumerate(words) if word in SOURCES_END), len(words))
        for source in words[2:end] + ([FUZZ_TESTS] if command == "sidestep_add_fuzzer" else []):
            self.cases += test_cases(program, texts.get(os.path.normpath(os.path.join(folder, source)), ""))

    def is_selected_by_pattern(self, pattern):
        """Whether ctest selects a test by the pattern."""
        return any(re.search(pattern, title) for title in self.titles)

    def is_selected_by_filter(self, program, text):
        """Whether each alternative of a program's Catch2 filter selects a test."""
        cases = [case for case in self.cases if case.program == program]
        return all(any(is_selected(case, part) for case in cases) for part in FILTER_PART.findall(text))


def is_selected(case, part):
    """Whether a filter without alternatives selects a test case: terms are names and tags, ~ excludes."""
    return all(matches(case, tag, name) != bool(tilde)
               for tilde, tag, name in FILTER_TERM.findall(part) if tag or name.strip())


def matches(case, tag, name):
    if tag:
        return tags_of(f"[{tag}]") <= case.tags
    name = name.strip()
    begins, ends = name.startswith("*"), name.endswith("*") and not name.endswith("\\*")
    wanted = re.sub(r"\\(.)", r"\1", name[begins:len(name) - ends]).lower()
    have = case.name.lower()
    if begins and ends:
        return wanted in have
    return have.endswith(wanted) if begins else have.startswith(wanted) if ends else have == wanted


def dead_commands(tests, name, text):
    """The commands in text `name` that select no test, as offsets and problems."""
    for match in CTEST_PATTERN.finditer(text):
        pattern = match.group(1).strip('"')
        if "$" not in pattern and not tests.is_selected_by_pattern(pattern):  # not a pattern of a script
            yield match.start(1), f"no test for -R \"{pattern}\""
    for match in PROGRAM_RUN.finditer(text):
        program, words = match.group(1), match.group(2)
        if program not in tests.programs and program.islower():  # not a placeholder such as fuzz_NAME
            yield match.start(1), f"no program {program}"
        elif words and any(case.program == program for case in tests.cases):
            if not tests.is_selected_by_filter(program, words[1:-1]):
                yield match.start(2), f"no test case for {program} {words}"
    if name.endswith(".mutant"):
        for match in MUTANT_PROGRAMS.finditer(text):
            yield from ((match.start(), f"no program {word}") for word in match.group(1).split()
                        if word not in tests.programs)
