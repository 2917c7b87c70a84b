"""Scripts to run and to copy: ``python -m blisk.examples`` lists them."""
