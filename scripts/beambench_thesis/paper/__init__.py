"""The thesis's figures as printed, and measured runs in the same form."""
