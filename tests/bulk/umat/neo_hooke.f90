! Compressible neo-Hooke: lambda, mu; sigma = (mu/J) (b - 1) + (lambda/J) ln J 1, with the tangent of Jaumann's rate.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, dtemp, predef, &
                dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, &
                kspt, jstep, kinc)
   implicit none
   character(len=80) :: cmname
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc, a, b
   double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), drpldt, &
                       stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
                       drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), f(3, 3), left(3, 3), s(3, 3), one(3, 3), volume, shear
   integer, parameter :: row(6) = (/1, 2, 3, 1, 1, 2/), column(6) = (/1, 2, 3, 2, 3, 3/)
   integer :: i, j, k, l
   f = dfgrd1
   volume = f(1, 1)*(f(2, 2)*f(3, 3) - f(2, 3)*f(3, 2)) - f(1, 2)*(f(2, 1)*f(3, 3) - f(2, 3)*f(3, 1)) &
            + f(1, 3)*(f(2, 1)*f(3, 2) - f(2, 2)*f(3, 1))
   left = matmul(f, transpose(f))
   one = 0
   do i = 1, 3
      one(i, i) = 1
   end do
   s = (props(2)*(left - one) + props(1)*log(volume)*one)/volume
   shear = (props(2) - props(1)*log(volume))/volume
   do a = 1, ntens
      i = row(a)
      j = column(a)
      stress(a) = s(i, j)
      do b = 1, ntens
         k = row(b)
         l = column(b)
         ddsdde(a, b) = props(1)/volume*one(i, j)*one(k, l) + shear*(one(i, k)*one(j, l) + one(i, l)*one(j, k)) &
                        + 0.5d0*(one(i, k)*s(j, l) + one(i, l)*s(j, k) + s(i, k)*one(j, l) + s(i, l)*one(j, k))
      end do
   end do
end subroutine umat
