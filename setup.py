"""Which packages are installed; all else is in pyproject.toml.

The studies of the paper stand at the top of the repository, where they are read and edited, and are installed as data
of the package `study`, so that `roughcoat plot --run fig03` works in any folder. So are the pages of docs/, which
`roughcoat docs` shows.

An editable install goes without them: `study` finds them in the repository. So all packages lie where their names say,
and setuptools installs the path of the repository. Otherwise it would install a finder, which Python asks last: a
user's folder `study` with nothing but data in it would be imported in place of the package.
"""

import sys

from setuptools import find_packages, setup

DATA = {} if "editable_wheel" in sys.argv else {"study.studies": "studies", "study.docs": "docs"}

PACKAGES = find_packages(include=["roughcoat*", "solver*", "study*"])

setup(packages=[*PACKAGES, *DATA], package_dir={"": ".", **DATA})
