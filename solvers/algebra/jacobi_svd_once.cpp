#include <Eigen/SVD>

template class Eigen::JacobiSVD<Eigen::MatrixXd>;
