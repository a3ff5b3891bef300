"""Every example of the pages about Python runs, in order, in one folder for each page."""
import pathlib
import re
import shutil

import pytest


def examples(text):
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("page, least", [("python.md", 6), ("coming_from_python.md", 4)])
def test_the_examples_run(page, least, root, tmp_path, monkeypatch):
    shutil.copytree(root / "diagrams", tmp_path / "diagrams")
    monkeypatch.chdir(tmp_path)
    blocks = examples((root / "docs" / page).read_text(encoding="utf-8"))
    assert len(blocks) >= least
    names = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"docs/{page}, example {number + 1}", "exec"), names)


def test_the_type_declarations_name_what_the_package_has(root):
    import ast
    import loopwright
    declared = ast.parse((pathlib.Path(loopwright.__file__).resolve().parent / "__init__.pyi").read_text())
    classes = {node.name: node for node in declared.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in declared.body if isinstance(node, ast.FunctionDef)}
    assert set(loopwright.__all__) == set(classes) | functions | set()
    for name, node in classes.items():
        stated = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        stated |= {item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}
        actual = {member for member in vars(getattr(loopwright, name)) if not member.startswith("_")}
        assert actual <= stated, name
