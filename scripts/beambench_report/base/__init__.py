"""What every part of the package uses: records, names, figures, files, published figures."""
