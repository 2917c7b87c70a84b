"""From the files of other codes to an import file and its matrices."""
