"""Many inputs: dispatch, plan, run, report."""
