"""The three papers, row by row: each figure of the print with the program's, against independent references."""
