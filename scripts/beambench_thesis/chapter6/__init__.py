"""The thesis's cluster (chapter 6), simulated with the costs of real beams."""
