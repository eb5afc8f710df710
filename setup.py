"""Which packages are installed; all else is in pyproject.toml.

The studies of the paper stand at the top of the repository, where they are read and edited, and are installed as data
of the package `study`, so that `roughcoat plot --run fig03` works in any folder.
"""

from setuptools import find_packages, setup

setup(
    packages=[*find_packages(include=["solver*", "study*"]), "study.studies"],
    package_dir={"study.studies": "studies"},
)
