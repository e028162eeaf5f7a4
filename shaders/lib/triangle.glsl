// Symmetric 6 x 6 matrices, kept as their upper triangle by rows. Loops over it run over all columns and skip those below
// the diagonal: loops whose bounds depend on an outer counter are not unrolled by every compiler, and then index memory.

/// Where entry (row, column), row <= column, is kept.
uint triangle_at(uint row, uint column) {
  return row * (11 - row) / 2 + column;
}
