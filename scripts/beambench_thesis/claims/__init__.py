"""The claims of the thesis: rules, and verdicts by the thesis's figures and by runs."""
