"""Settings of the site that `make docs` builds: Sphinx reads docs/ as it is, and the pages of reference.py."""

import json
import re
import sys
import warnings
from importlib.metadata import files
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import reference  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from sphinx.util.fileutil import copy_asset  # noqa: E402
from sphinx_gallery.scrapers import figure_rst, matplotlib_scraper  # noqa: E402

import roughcoat  # noqa: E402
from study.explorer import page as explorer  # noqa: E402

project, author, version = "roughcoat", "the authors of roughcoat", roughcoat.__version__
copyright = author
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "numpydoc",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
root_doc = "index"
exclude_patterns = ["_build", "gallery/*.rst", "notebooks"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
suppress_warnings = ["config.cache"]  # the order of the gallery is a function, which Sphinx cannot keep
pygments_style = "default"

# The pages are written for GitHub: formulas in $ and ```math, links to headings by their words.
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4

# Browsable from disk without a network: one file of MathJax, no fonts or scripts of other hosts.
mathjax_path = "tex-svg.js"
html_theme = "pydata_sphinx_theme"
html_static_path, html_css_files = ["static"], ["site.css"]
html_title = f"roughcoat {version}"
html_theme_options = {
    "show_prev_next": False,
    "secondary_sidebar_items": ["page-toc"],
    "navbar_align": "left",
    "header_links_before_dropdown": 8,
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_show_sphinx = html_show_sourcelink = False
html_copy_source = False

numpydoc_show_class_members = False
autodoc_typehints = "none"  # the sections of a docstring say what a parameter may be
default_role = "code"  # `name` in a docstring
nitpicky = True


#: Sphinx's search fetches a page to quote it below its title; if the site is opened from disk, TEXTS has the page.
ASIDES = '<a class="headerlink".*?</a>|<div class="sphx-glr-download-link-note.*?</div>'
FETCH = """if (location.protocol === "file:") {
  const root = new URL(document.documentElement.dataset.content_root || "./", location.href).href;
  window.fetch = async (url) => {
    const page = new URL(url, location.href).href.replace(root, "").split("#")[0];
    return new Response(`<div role="main">${TEXTS[page] || ""}</div>`);
  };
}
"""


#: The page that solves, in another page.
EXPLORER = '<iframe class="explorer" src="_static/contact.html" title="roughcoat explorer" loading="lazy"></iframe>'


def _pictures(block, block_vars, conf):
    """A scraper of pictures: those of pyplot, and the figures of `rc.plot`, which are none of pyplot."""
    made, known = [], block_vars["example_globals"].setdefault("_pictures", set())
    for figure in block_vars["example_globals"].values():
        if isinstance(figure, Figure) and not hasattr(figure, "number") and id(figure) not in known:
            known.add(id(figure))
            made.append(next(block_vars["image_path_iterator"]))
            figure.savefig(made[-1])
    return figure_rst(made, conf["src_dir"]) + matplotlib_scraper(block, block_vars, conf, bbox_inches="tight")


#: A warning in the output of a script without the folder in which this site is built.
warnings.formatwarning = lambda message, category, *_: f"{category.__name__}: {message}\n"

sphinx_gallery_conf = {
    "image_scrapers": (_pictures,),
    "capture_repr": ("_repr_html_",),
    "examples_dirs": [str(HERE.parent / "gallery")],
    "gallery_dirs": ["examples"],
    "within_subsection_order": "FileNameSortKey",
    "show_memory": False,
    "write_computation_times": False,  # its pages load from another host
    "download_all_examples": False,
    "remove_config_comments": True,
    "matplotlib_animations": False,
}


def _assets(app, error) -> None:
    if error is None:
        found = next(path for path in files("sphinx-mathjax-offline") if path.name == "tex-svg.js")
        copy_asset(str(found.locate()), str(Path(app.outdir) / "_static"))
        (Path(app.outdir) / "_static/contact.html").write_text(explorer.page(), encoding="utf-8")


def _texts(app, error) -> None:
    """Write the texts of all pages for the page that searches: from disk, a browser lets it read no other page."""
    if error is None:
        folder = Path(app.outdir)
        texts = {}
        for path in sorted(folder.rglob("*.html")):
            if article := re.search(r"<article\b.*?</article>", path.read_text(encoding="utf-8"), flags=re.DOTALL):
                words = re.sub(f"{ASIDES}|<[^>]*>", "", article[0], flags=re.DOTALL)
                texts[path.relative_to(folder).as_posix()] = " ".join(words.split())
        (folder / "_static/texts.js").write_text(f"const TEXTS = {json.dumps(texts)};\n{FETCH}", encoding="utf-8")


def _search(app, pagename, templatename, context, doctree) -> None:
    if pagename == "search":
        app.add_js_file("texts.js")


def _plain(app, what, name, thing, options, lines) -> None:
    """Docstrings are plain text: E2* begins no emphasis, |x| is no substitution, docs/fit.md is a page."""
    for number, line in enumerate(lines):
        if not line.lstrip().startswith(">>>"):
            lines[number] = reference.pages_linked(re.sub(r"(?<!`)([*|])(?!`)", r"\\\1", line))


def _links_out(app, docname, source) -> None:
    source[0] = reference.links_inside(source[0], docname)
    if docname == "explorer":  # on the page about it, before its table
        words, table = source[0].split("\n\n| on the page |", 1)
        source[0] = f"{words}\n\n```{{raw}} html\n{EXPLORER}\n```\n\n| on the page |{table}"


def setup(app) -> None:
    """Write the pages of the reference before Sphinx reads, and add MathJax and the explorer when it has written."""
    app.connect("builder-inited", lambda _: reference.write(HERE.parent / "reference"))
    app.connect("autodoc-process-docstring", _plain, priority=100)  # before numpydoc
    app.connect("source-read", _links_out)
    app.connect("build-finished", _assets)
    app.connect("build-finished", _texts)
    app.connect("html-page-context", _search)
