"""The thresholds of tools/diagnose/criteria.h, and of the file that it includes, as variables, for the sensitivity run alone: in the product
they are constants.

    variable_criteria.py CRITERIA VARIABLE_CRITERIA

Each `constexpr double name = value` becomes an inline variable, and a table of all of them follows at the end.
"""

import pathlib
import re
import sys

DECLARATION = re.compile(r"^constexpr (double|int|size_t) (\w+(?:\[\])? = [^;]*);", re.MULTILINE)
ENTRY = re.compile(r"(\w+)(\[\])? = (\{[^}]*\}|[^,{]+)(?:, |$)")
TABLE = """
/// A threshold, or all numbers of a list; the pointer of its type is set.
struct Threshold {
  std::string_view name;
  std::span<double> numbers;
  int* whole = nullptr;
  size_t* count = nullptr;
};
inline std::vector<Threshold> all_thresholds() {
  return {
%s  };
}

}  // namespace loopwright::diagnosis::criteria
"""


INCLUDED = re.compile(r'^#include "tools/diagnose/(\w+\.h)"\n', re.MULTILINE)


def criteria(path):
    """The text of the file, with those that it includes in their places."""
    return INCLUDED.sub(lambda match: (path.parent / match[1]).read_text(), path.read_text())


def thresholds(text):
    """(type, name, whether it is a list, value) in the order of the file."""
    return [(kind, name, bool(is_list), value) for kind, entries in DECLARATION.findall(text)
            for name, is_list, value in ENTRY.findall(" ".join(entries.split()))]


def entry(kind, name, is_list):
    if is_list:
        return f'      {{"{name}", {name}}},\n'
    place = {"double": f"{{&{name}, 1}}", "int": f"{{}}, &{name}", "size_t": f"{{}}, nullptr, &{name}"}[kind]
    return f'      {{"{name}", {place}}},\n'


def variable(text):
    names = thresholds(text)
    text = DECLARATION.sub(r"inline \1 \2;", text)
    assert "constexpr" not in text, "a constant of a kind that this script does not know"
    text = text.replace("#include <cstddef>\n", "#include <cstddef>\n#include <span>\n#include <string_view>\n#include <vector>\n", 1)
    head, _, _ = text.rpartition("}  // namespace")
    return head.rstrip() + "\n" + TABLE % "".join(entry(kind, name, is_list) for kind, name, is_list, _ in names)


if __name__ == "__main__":
    constants, variables = map(pathlib.Path, sys.argv[1:])
    variables.parent.mkdir(parents=True, exist_ok=True)
    variables.write_text(variable(criteria(constants)))
