"""Running a study: plan, cost, workers, progress."""
