"""The command line, `roughcoat COMMAND` or `python -m roughcoat COMMAND`: that of `study`."""

from study.__main__ import command, own_modules_first

if __name__ == "__main__":
    own_modules_first()
    command()
