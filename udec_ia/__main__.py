"""`python -m udec_ia` is the command `udec`."""

import sys

from udec_ia.cli import main

sys.exit(main())
