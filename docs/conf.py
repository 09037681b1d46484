"""How Sphinx makes the site of these pages: `python3 -m docs`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

project = "servoident"
copyright = "the authors of servoident"  # noqa: A001 - Sphinx' own name
extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["_site", "blind-trials.jsonl", "**/.ipynb_checkpoints"]
html_theme = "furo"
html_title = "servoident"
html_static_path = ["site"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
myst_heading_anchors = 4
myst_links_external_new_tab = False
autodoc_typehints = "none"  # signatures stay legible; the docstrings say what comes in
autodoc_preserve_defaults = True
autodoc_member_order = "bysource"
smartquotes = False  # code stands in texts


class DarkPictures(SphinxTransform):
    """Beside a picture of which there is a dark one, `bode-dark.png` beside `bode.png`, that one for dark pages."""

    default_priority = 210

    def apply(self, **_: Any) -> None:
        """Give each the class by which the theme shows the one or the other."""
        for light in list(self.document.findall(nodes.image)):
            path = Path(light["uri"])
            name = path.with_name(f"{path.stem}-dark{path.suffix}")
            if not (Path(self.document["source"]).parent / name).exists():
                continue
            dark = light.deepcopy()
            dark["uri"] = str(name)
            light["classes"].append("only-light")
            dark["classes"].append("only-dark")
            light.parent.insert(light.parent.index(light) + 1, dark)


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.add_transform(DarkPictures)
