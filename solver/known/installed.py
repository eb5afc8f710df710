"""The laws of installed packages, which declare them as entry points."""

from functools import cache

from ..laws import trial

#: The group of these entry points.
GROUP = "roughcoat.laws"


@cache
def laws():
    """A list of pairs (law, where it is from) from all entry points, each of which is a :class:`Law` or a list of laws;
    and a list of error messages."""
    from importlib.metadata import entry_points  # imported here: it takes a while, and most studies do not need it

    wrong, places = [], {}
    for entry in entry_points(group=GROUP):
        where = f"entry point {entry.name} = {entry.value} of {GROUP}"
        try:
            with trial.going_on():
                loaded = entry.load()
            for law in loaded if isinstance(loaded, (list, tuple)) else [loaded]:
                places.setdefault(law.name, {}).setdefault(law, where)
        except MemoryError:
            raise
        except Exception as error:
            wrong.append(f"{where}: {error}")
    for name, of_name in places.items():
        if len(of_name) > 1:
            wrong.append(f"{' and '.join(of_name.values())} have laws of one name, {name}: one must go")
    return [pair for of_name in places.values() if len(of_name) == 1 for pair in of_name.items()], wrong
