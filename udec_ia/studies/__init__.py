"""Studies of decks: sweeps, what accuracy costs, problems with exact answers, two runs side by side.

Shared by all: study_run.py (a run and its result), execute_run.py (how one is executed and observed),
run_folder.py, worker_pool.py (many of them), quantities.py, study_table.py.
On top: sweep.py; accuracy_study.py and what it imports (trade); verification.py; divergence.py.
"""
