"""Make the pictures and the page of the gallery from the scripts in examples/gallery.

python tools/gallery_page.py           run all scripts, then write docs/scripts.md
python tools/gallery_page.py --page    write the page only
python tools/gallery_page.py NAME ...  run these scripts only, then write the page
"""

from __future__ import annotations

import argparse
import ast
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCRIPTS = ROOT / "examples" / "gallery"
PICTURES = ROOT / "docs" / "images" / "scripts"
PAGE = ROOT / "docs" / "scripts.md"

_HEAD = """\
# Gallery

{count} short scripts, each with its picture. Each ends in an assertion: a number of theory, of an
independent program, or of the model's own laws, which the run has to meet. All are run by the
tests. Take the nearest one and change it.

The nine cells that the paper names are on [a page of their own](gallery.md).

"""
_ENTRY = """\
## {title}

{text}

![{title}]({picture})

:::{{dropdown}} {name}
```{{literalinclude}} ../examples/gallery/{name}
:language: python
```
{{download}}`Download <../examples/gallery/{name}>`
:::

"""


def scripts() -> list[Path]:
    """Return the scripts, in their order."""
    return sorted(SCRIPTS.glob("[0-9][0-9]_*.py"))


def run(script: Path) -> None:
    """Run a script in an empty folder and keep its pictures; its assertions must hold."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, str(script)], cwd=folder, check=True)
        made = sorted(Path(folder).glob(f"{script.stem}.[gp][in][fg]"))
        if not made:
            raise SystemExit(f"{script.name} has left no {script.stem}.png")
        PICTURES.mkdir(parents=True, exist_ok=True)
        for picture in made:
            shutil.copyfile(picture, PICTURES / picture.name)


def entry(script: Path) -> str:
    """Return what the page says of a script: the words are those of its docstring."""
    title, _, text = (ast.get_docstring(ast.parse(script.read_text("utf-8"))) or "").partition("\n")
    moving = PICTURES / f"{script.stem}.gif"
    picture = moving if moving.exists() else moving.with_suffix(".png")
    return _ENTRY.format(
        title=title.removesuffix("."),
        text=text.strip(),
        picture=picture.relative_to(PAGE.parent).as_posix(),
        name=script.name,
    )


def page() -> str:
    """Return the page."""
    entries = [entry(script) for script in scripts()]
    return (_HEAD.format(count=len(entries)) + "".join(entries)).rstrip() + "\n"


def main() -> None:
    """Run what is asked for, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="Names of scripts, or their beginnings.")
    parser.add_argument("--page", action="store_true", help="Run nothing.")
    asked = parser.parse_args()
    for script in [] if asked.page else scripts():
        if not asked.names or script.name.startswith(tuple(asked.names)):
            print(script.name, flush=True)
            run(script)
    PAGE.write_text(page(), "utf-8")


if __name__ == "__main__":
    main()
