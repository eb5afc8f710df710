"""The numbers that the paper prints, from numbers.toml, which says what they are."""

import tomllib
from importlib.resources import files

_PRINTED = tomllib.loads((files(__package__) / "numbers.toml").read_text(encoding="utf-8"))
TABLE1 = tuple(map(tuple, _PRINTED["table1"]))
NUMBERS = _PRINTED["numbers"]
ERROR_INTERVAL = tuple(_PRINTED["error_interval"])
ERROR_BOUNDS = dict(_PRINTED["error_bounds"])
