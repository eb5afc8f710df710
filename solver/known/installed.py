"""The laws of installed packages, which these name as entry points."""

from functools import cache

from ..laws import trial

#: Entry points of this group are laws of installed packages.
GROUP = "roughcoat.laws"


@cache
def laws():
    """[(law, where it is from)] of all entry points, each a :class:`Law` or a list of them; texts of what is wrong."""
    from importlib.metadata import entry_points  # takes a while, and most studies have no need of it

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
