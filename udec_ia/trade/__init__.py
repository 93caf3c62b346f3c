"""`udec trade DECK`: what accuracy costs, for the user's own deck.

Levers. A setting is the word scheme and what is written in the deck instead of its own lines (levers.py,
deck.py, writing.py). Two kinds are kept apart:

- levers of accuracy: word scheme, FRACTION, FRACTION f SAFE, and the ratio of SOLVE or SOLVE r STATIC where a
  deck seeks nothing but rest. They change how well a model is calculated, and not the model. Their errors are
  those against one reference.
- levers of the model, varied on request: rounding length, size of zones, joint stiffness, types of blocks.
  Another value is another model. Each is compared with its own refinement (model.py).

A lever applies where the deck's text has the line that it changes: no zones without GENERATE AUTOMATIC.

Time. CYCLE counts cycles, and physics is a matter of time. So the deck is run once as it is, and watched
(surveyed.py): at the begin of each CYCLE the time-step is noted, with the estimate and the safe bound that
it is a fraction of. A setting makes a time-step from one of these; so the cycles that each CYCLE must have
for the same time are known before it is run (steps.py). What rounding to whole cycles leaves is carried to
the next CYCLE, so that the end is off by half a step at most; and of the fractions a few per cent below the
one that is asked for the one is taken that fits best: for halves and doubles that is most often the very
one, and the time exact. HISTORY's intervals follow. SOLVE ends by itself, its LIMIT follows. Each run is
watched as well: where a CYCLE has another fraction than was meant, as the deck sets it by other means, or
the time comes out differently, the run is not compared (meant.py).

Reference. The deck is run in 64-bit reals with its step, a half and a quarter of it, where all that is left
is the error of the time-step. Where the three numbers converge with an order between 0.5 and 3,
Richardson's extrapolation is the reference, and the whole correction counts as its error. Where they
scatter, the finest is taken, if their spread is small against the tolerance; else the quantity has no limit
at these steps, no setting has an error, and what remains comparable is said: where and when runs part, and
how far numbers spread (limit.py, parting.py). If errors are too large for the tolerance, and shrink, the
step is halved again.

Cost. Before anything is run, a rehearsal runs a few hundredths of a second of every CYCLE, for each word
scheme; the survey then tells the seconds of each CYCLE. Seconds of a setting are those of preparing, and for
each CYCLE its cycles times seconds a cycle (cost.py); STATIC is expected to take as many fewer cycles as
docs/rest.md has measured. Settings run in batches, STATIC first and then the cheapest, one alone of a word
scheme that has not run yet (batches.py). After each batch what it has really taken is taken from the budget,
and what is ahead predicted anew if that was far more. Settings whose turn does not come within the budget
are dropped, the dearest first, and named; so are those of words that allow no rest, and word schemes that
do not come to a first cycle.

Recommendation. The cheapest setting with (error + error of the reference) within the tolerance, for every
quantity that has a limit. A quantity that is the same number at all steps tells nothing of them: it
recommends nothing where another one has no limit. The margin is the reference's own error: a measured error
is known to no more than that. 32-bit reals are recommended only where they save more time than times scatter
by. It holds for this deck, at these quantities: nothing is said of other ones. What SOLVE has to say of the
deck as it is, joints that have slipped or no rest, stands beside it.

Digits (`--digits`, noise.py, digits.py). An ensemble of runs, in which every real that a cycle has changed
is moved by up to one unit in the last place, at random: that is what rounding a second time, at random,
would do. The digits that all runs share are those that the deck determines. Noise that passes in proportion
to the word is rounding: 64-bit reals have 8.7 digits more than 32-bit ones. Where they do not, the motion
itself takes the digits: chaos. What halving the time-step changes is the error of the step. `--blame`
(blame.py) puts the noise into some fields only, and halves their set until few of them explain the loss.
"""
