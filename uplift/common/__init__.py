"""What every layer needs: array types, errors, atomic writing of files, threads of linear algebra."""
