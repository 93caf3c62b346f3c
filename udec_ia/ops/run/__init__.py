"""What CYCLE and SOLVE do around the compiled cycle: order, time-step, watching, stopping."""
