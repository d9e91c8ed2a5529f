"""python -m trsim"""

from trsim.cli import main

if __name__ == "__main__":
    main()
