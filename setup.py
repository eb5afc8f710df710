"""Which packages are installed; all else is in pyproject.toml.

The studies of the paper stand at the top of the repository, where they are read and edited, and are installed as data
of the package `study`, so that `roughcoat plot --run fig03` works in any folder. So are the pages of docs/, which
`roughcoat docs` shows.

An editable install goes without them: `study` finds them in the repository. So all packages lie where their names say,
and setuptools installs the path of the repository. Otherwise it would install a finder, which Python asks last: a
user's folder `study` with nothing but data in it would be imported in place of the package.

The compiled core of the solver is optional: without a compiler, or with one that knows no vectors, nothing fails, and
numpy computes (solver/compiled).
"""

import sys
from pathlib import Path

from setuptools import Extension, find_packages, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_ext import build_ext

DATA = {} if "editable_wheel" in sys.argv else {"study.studies": "studies", "study.docs": "docs"}

PACKAGES = find_packages(include=["roughcoat*", "solver*", "study*"])

FOLDER = "solver/compiled"

#: Loaded by ctypes: it is no module of Python. Each of the sources is the core for one kind of vectors.
CORE = Extension(
    "solver.compiled._core",
    sources=[f"{FOLDER}/{vectors}.c" for vectors in ("sse2", "avx2", "avx512")],
    depends=[
        f"{FOLDER}/{name}.h"
        for name in ("batch", "lanes", "laws", "newton", "cases", "run", "sticking", "bessel", "waves", "boxes", "core")
    ],
    # -Wno-psabi: functions with vectors in their arguments are all static. -O2 after what Python was built with.
    extra_compile_args=["-std=gnu11", "-O2", "-fno-math-errno", "-ffp-contract=fast", "-Wno-psabi", "-g0"],
    optional=True,
)


class build_core(build_ext):
    """Say in one line that there is no core, which `roughcoat --version` says later.

    The name of the file has no version of Python, since every Python loads it: in a wheel and beside its sources.
    """

    def get_ext_filename(self, fullname):
        name = super().get_ext_filename(fullname)
        return name.partition(".")[0] + Path(name).suffix

    def build_extension(self, ext):
        try:
            super().build_extension(ext)
        except Exception:  # which setuptools forgives, since the core is optional
            self.warn("no compiled core was built (is there a C compiler?): numpy computes, 3 to 6 times slower")
            raise


class one_wheel(bdist_wheel):
    """A wheel for each platform, and for all versions of Python: nothing in it is linked with Python."""

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


setup(
    packages=[*PACKAGES, *DATA],
    package_dir={"": ".", **DATA},
    ext_modules=[CORE],
    cmdclass={"build_ext": build_core, "bdist_wheel": one_wheel},
)
