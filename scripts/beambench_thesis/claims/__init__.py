"""The claims of the thesis: rules, and their verdicts by its own figures and by a run's."""
