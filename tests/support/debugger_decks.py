"""Decks for the debugger: a small pile that slides, breaks up and loses a block, in a few hundred cycles."""

from __future__ import annotations

PILE = """START
PROPERTY MAT=1 DENSITY=2000 KN=8E6 KS=8E6 FRICTION=0.02 BULK=1E7 G=5E6
GRAVITY 0 -20
BLOCK 0,0 0,4 4,4 4,0
SPLIT -1,1 5,1.4
SPLIT -1,2 5,2.6
SPLIT 2,-1 2,5
ROUND 0.08
CHANGE 0,2 1,2 SDEF
FIX 0,4 0,1
HISTORY 5 UNBALANCED
CYCLE 60
DELETE 2,4 1,2.3
CYCLE 360
FRACTION 0.12
CYCLE 40
STOP
"""
