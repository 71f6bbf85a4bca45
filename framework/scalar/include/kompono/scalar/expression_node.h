/* SPDX-License-Identifier: Apache-2.0 */
#ifndef KOMPONO_SCALAR_EXPRESSION_NODE_H_
#define KOMPONO_SCALAR_EXPRESSION_NODE_H_

#include <stdint.h>

/* A recorded formula as plain data: a list of nodes, each naming its operands by their index in the
 * list (always smaller than its own). This is the form in which formulas leave a plugin; numbers of
 * operations never change their meaning. */
typedef enum KomponoOperation {
  KOMPONO_CONSTANT = 0, /* value */
  KOMPONO_VARIABLE = 1, /* operand[0] = number of the variable */
  KOMPONO_ADD = 2,
  KOMPONO_SUBTRACT = 3,
  KOMPONO_MULTIPLY = 4,
  KOMPONO_DIVIDE = 5,
  KOMPONO_NEGATE = 6,
  KOMPONO_SQRT = 7,
  KOMPONO_SIN = 8,
  KOMPONO_COS = 9,
  KOMPONO_TAN = 10,
  KOMPONO_ASIN = 11,
  KOMPONO_ACOS = 12,
  KOMPONO_ATAN = 13,
  KOMPONO_ATAN2 = 14, /* atan2(operand[0], operand[1]) */
  KOMPONO_ABS = 15,
  KOMPONO_EXP = 16,
  KOMPONO_LOG = 17,
  KOMPONO_LESS = 18,       /* a condition: operand[0] < operand[1] */
  KOMPONO_LESS_EQUAL = 19, /* a condition: operand[0] <= operand[1] */
  KOMPONO_NOT = 20,        /* of a condition */
  KOMPONO_AND = 21,        /* of two conditions */
  KOMPONO_OR = 22,         /* of two conditions */
  KOMPONO_SELECT = 23      /* operand[0] is a condition: true -> operand[1], false -> operand[2] */
} KomponoOperation;

/* How many operands of an operation are nodes; -1: no operation. */
static inline int KomponoOperandCount(int32_t operation) {
  switch (operation) {
    case KOMPONO_CONSTANT:
    case KOMPONO_VARIABLE:
      return 0;
    case KOMPONO_ADD:
    case KOMPONO_SUBTRACT:
    case KOMPONO_MULTIPLY:
    case KOMPONO_DIVIDE:
    case KOMPONO_ATAN2:
    case KOMPONO_LESS:
    case KOMPONO_LESS_EQUAL:
    case KOMPONO_AND:
    case KOMPONO_OR:
      return 2;
    case KOMPONO_SELECT:
      return 3;
    default:
      return operation > KOMPONO_VARIABLE && operation < KOMPONO_SELECT ? 1 : -1;
  }
}

typedef struct KomponoExpressionNode {
  int32_t operation;
  int32_t operand[3]; /* unused ones are -1 */
  double value;       /* of a constant, else 0 */
} KomponoExpressionNode;

#endif /* KOMPONO_SCALAR_EXPRESSION_NODE_H_ */
