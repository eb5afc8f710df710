"""From a study file or keywords to a checked grid of cases."""
