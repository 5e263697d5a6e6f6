"""``python -m vorotool``."""

from vorotool.cli.main import main

if __name__ == "__main__":
    main()
