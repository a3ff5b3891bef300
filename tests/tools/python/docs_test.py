"""Every example of docs/python.md runs, in order, in one folder."""
import pathlib
import re
import shutil


def examples(text):
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_examples_of_the_guide_run(root, tmp_path, monkeypatch):
    shutil.copytree(root / "diagrams", tmp_path / "diagrams")
    monkeypatch.chdir(tmp_path)
    blocks = examples((root / "docs" / "python.md").read_text(encoding="utf-8"))
    assert len(blocks) >= 6
    names = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"docs/python.md, example {number + 1}", "exec"), names)


def test_the_stubs_name_what_the_package_has(root):
    import ast
    import loopwright
    stub = ast.parse((pathlib.Path(loopwright.__file__).resolve().parent / "__init__.pyi").read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert set(loopwright.__all__) == set(classes) | functions | set()
    for name, node in classes.items():
        stated = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        stated |= {item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}
        actual = {member for member in vars(getattr(loopwright, name)) if not member.startswith("_")}
        assert actual <= stated, name
