# SPDX-License-Identifier: MIT
"""Sphinx's configuration; `make docs` has laid out the pages (sphinx_sources.py)."""
import re
from pathlib import Path

HERE = Path(__file__).resolve().parent

project = "rhotrack"
header = (HERE.parents[1] / "include/rhotrack/rhotrack.h").read_text()
version = release = ".".join(re.findall(r"^#define RHO_VERSION_\w+ (\d+)", header, re.MULTILINE))
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_gallery.gen_gallery"]
source_suffix = {".rst": "restructuredtext", ".md": "markdown"}
html_theme = "furo"
html_title = f"rhotrack {version}"
html_static_path = [str(HERE / "static")]
html_css_files = ["docs.css"]
html_show_copyright = html_show_sphinx = html_copy_source = False
pygments_style = "friendly"
highlight_language = "none"  # of blocks that say no other

myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # documents may begin below a first heading
c_id_attributes = ["RHO_MUST_CHECK"]
nitpicky = True
nitpick_ignore_regex = [
    ("c:identifier", r"u?int\d+_t|size_t|rho_bearing_set"),
    ("py:class", r"np\..*|numpy\..*|os\.PathLike|Any|optional|Scans|Kalman|Settings"),
]
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": True}

ORDER = ["getting_started", "your_own_data", "your_radar", "paper_initiation", "paper_maintenance",
         "paper_passive", "matlab_example_redone"]


class Order:
    """Examples in the order of the reading."""

    def __init__(self, _folder):
        pass

    def __call__(self, name):
        return ORDER.index(Path(name).stem)


sphinx_gallery_conf = {
    "examples_dirs": str(HERE / "examples"),
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "within_subsection_order": Order,
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "min_reported_time": 3600,  # no times: pages are the same on every machine
    "capture_repr": ("_repr_html_",),
    "show_signature": False,
}


def setup(app):
    """Fields of named tuples have no text but that they are fields."""
    app.connect("autodoc-skip-member", lambda app, what, name, one, is_skipped, options: (
        True if (getattr(one, "__doc__", "") or "").startswith("Alias for field") else None))
