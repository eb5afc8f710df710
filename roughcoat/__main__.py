"""The command line, `roughcoat COMMAND` or `python -m roughcoat COMMAND`: that of `study`."""

from study.__main__ import command, search_working_folder_last

if __name__ == "__main__":
    search_working_folder_last()
    command()
