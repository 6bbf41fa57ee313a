"""`python -m rigdesign`: the command line where no script is on the path."""

from rigdesign.cli.main import main

if __name__ == "__main__":
    main()
