"""Which facilities of the program a state uses, what each takes, and what was asked for in vain.

A facility is what a scene may do without: zones, a damping, an account of the energy. A cycle runs what is in
use and nothing else, so whoever knows the price of each can decide what a scene is worth.
"""

from udec_ia.inspect.facilities.cost import costs
from udec_ia.inspect.facilities.facilities import facilities
from udec_ia.inspect.facilities.idle import idle

__all__ = ["costs", "facilities", "idle"]
