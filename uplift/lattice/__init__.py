"""The lattice over RGB: nodes, cells, neighbours, the boxes around atlas entries, and
the table of the nodes.
"""
